# What the shell tests share. Sourced by them: `source` is the root of the repository, `work` a folder that is removed at the
# end. ALHAZEN_MODULES is unset, so that what is installed finds its own modules.
source=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
unset ALHAZEN_MODULES

fail() {
  echo "$(basename "$0" .sh): $1" >&2
  exit 1
}

# MAJOR, MINOR or PATCH of the version.
version_number() { sed -n "s/^#define ALHAZEN_VERSION_$1 //p" "$source/include/alhazen/version.h"; }

# Installs the build folder $1 to $2; further arguments are those of cmake --install.
install_to() {
  cmake --install "$1" --prefix "$2" "${@:3}" >"$work/install.log" || { cat "$work/install.log"; fail "cmake --install"; }
}
