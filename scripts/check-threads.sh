#!/usr/bin/env bash
# Runs the tests of threads under ThreadSanitizer: builds the preset `threads` (GCC) and fails at the first data race.
# Arguments go to the tests: scripts/check-threads.sh --gtest_filter='Threads.Render*'
#
# ThreadSanitizer does not see how GCC's own OpenMP library synchronizes its threads and would report every loop. LLVM's
# library runs the same binaries, and its tool Archer tells the sanitizer of forks, joins and barriers. Debian has both
# in libomp-14-dev. Libraries that are not compiled with the sanitizer, such as OpenEXR's, are not examined.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

openmp=""
for folder in /usr/lib/llvm-*/lib; do
  [[ -e $folder/libarcher.so && -e $folder/libomp.so.5 ]] && openmp=$folder
done
if [[ -z $openmp ]]; then
  echo "check-threads: LLVM's OpenMP with Archer is not installed: apt-get install libomp-14-dev" >&2
  exit 77
fi

cmake --preset threads
cmake --build --preset threads
export OMP_TOOL_LIBRARIES=$openmp/libarcher.so
export TSAN_OPTIONS="ignore_noninstrumented_modules=1 halt_on_error=1 second_deadlock_stack=1"
LD_PRELOAD=$openmp/libomp.so.5 build/threads/tests/threads_tests "$@"
