#!/usr/bin/env bash
# The symbols that the installed library exports: those of the public headers under their version, and internals that the
# program or a module uses under a private one. Arguments: the build folder, nm.
set -euo pipefail
build=$1 nm=$2
. "$(dirname "${BASH_SOURCE[0]}")/../support/shell_test.sh"

public=ALHAZEN_$(version_number MAJOR).$(version_number MINOR)
private=ALHAZEN_PRIVATE_$(version_number MAJOR).$(version_number MINOR).$(version_number PATCH)
namespace="alhazen::v$(version_number MAJOR)_$(version_number MINOR)::"
users=("$build/bin/alhazen")
for module in "$build"/lib/alhazen/*.so; do
  if [[ -e $module ]]; then users+=("$module"); fi
done
"$nm" -D -P "${users[@]}" 2>/dev/null | sed -n 's/^\(_Z[^ @]*\)[ @].*/\1/p' | sort -u >"$work/used.txt"
cat "$source"/include/alhazen/*.h | tr -cs 'A-Za-z0-9_' '\n' | sort -u >"$work/words.txt"

# Prints the symbols of a library that it should not export, with the reason.
unexpected() {
  "$nm" -D -P --defined-only --with-symbol-versions "$1" | cut -d' ' -f1,2 >"$work/symbols.txt"
  sed 's/[@ ].*//' "$work/symbols.txt" | c++filt | paste -d'\t' "$work/symbols.txt" - >"$work/names.txt"
  awk -F'\t' -v public="$public" -v private="$private" -v namespace="$namespace" '
    FILENAME ~ /used.txt$/ { used[$1] = 1; next }
    FILENAME ~ /words.txt$/ { words[$1] = 1; next }
    {
      split($1, symbol, " ")
      mangled = version = symbol[1]
      sub(/@.*/, "", mangled)
      if (!sub(/.*@/, "", version)) version = ""
      name = $2
      sub(/^(typeinfo|typeinfo name|vtable|VTT|guard variable|TLS (init|wrapper) function|(non-)?virtual thunk) (for|to) /, "", name)
      # The dynamic linker has one unique symbol of a name in a process, whatever its version.
      if (symbol[2] == "u") { print $2 " would be shared with a library of another version"; next }
      if (symbol[2] == "A" && (mangled == public || mangled == private)) next
      if (version == public) {
        if (index(name, namespace) != 1) { print $2 " is not of the namespace " namespace; next }
        name = substr(name, length(namespace) + 1)
        sub(/[(<[].*/, "", name)
        sub(/.*[:~]/, "", name)
        sub(/^operator[^A-Za-z0-9_]*$/, "operator", name)
        if (!(name in words)) print $2 " is in no public header"
      } else if (version == private) {
        if (name !~ /(^| )alhazen::impl::/) print $2 " is not of alhazen::impl"
        if (!(mangled in used)) print $2 " is used by neither the program nor a module"
      } else {
        print $2 " has the version \047" version "\047"
      }
    }' "$work/used.txt" "$work/words.txt" "$work/names.txt"
}

library=$build/installed/libalhazen.so
unexpected "$library" >"$work/unexpected.txt"
[[ ! -s $work/unexpected.txt ]] || { cat "$work/unexpected.txt"; fail "the installed library exports too much"; }
for function in 'render(' 'version()' 'RenderedImage::plane('; do
  grep -qF "$namespace$function" "$work/names.txt" || fail "the installed library does not export $namespace$function"
done
echo "$(grep -c "@$public " "$work/symbols.txt") public symbols, $(grep -c "@$private " "$work/symbols.txt") internals"

# That of the build folder, which the tests are linked to, exports every internal: this check must see it.
unexpected "$build/lib/libalhazen.so" >"$work/unexpected.txt"
grep -q 'is used by neither' "$work/unexpected.txt" || fail "the check does not find internals that nothing uses"
grep -vE 'is used by neither|is in no public header|would be shared' "$work/unexpected.txt" >"$work/strange.txt" || true
[[ ! -s $work/strange.txt ]] || { cat "$work/strange.txt"; fail "the library of the build folder exports more than its namespaces"; }

# Kernels are weak symbols, and a library without them is linked all the same: those absent are the same in both.
absent() { "$nm" -D -P --undefined-only "$1" | grep -E '^_ZNK?7alhazen' | sed 's/[@ ].*//' | sort; }
diff <(absent "$build/lib/libalhazen.so") <(absent "$library") || fail "the installed library lacks kernels of the other one (>)"

readelf -d "$library" | grep -q "SONAME.*\[libalhazen.so.${public#ALHAZEN_}\]" || fail "the soname is not that of ${public#ALHAZEN_}"
for file in "${users[@]}"; do
  LD_LIBRARY_PATH=$build/installed ldd -r "$file" >"$work/ldd.txt" 2>&1
  grep -qF "$build/installed/libalhazen.so" "$work/ldd.txt" || echo "note: $file is bound to the library of its RUNPATH"
  ! grep -E 'undefined symbol|version .* not found' "$work/ldd.txt" || fail "$file needs more than the installed library exports"
done
