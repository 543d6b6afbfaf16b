"""Runs pytest with the arguments; ends with 77, which CTest reports as skipped, where pytest is not installed."""

import sys

try:
    import pytest
except ImportError:
    print("pytest is not installed (Debian: python3-pytest): the tests of the Python module are skipped")
    sys.exit(77)

sys.exit(pytest.main(["-q", "-rs", "-p", "no:cacheprovider", *sys.argv[1:]]))
