#!/usr/bin/env bash
# Completions of the command line, in bash and, where they are installed, zsh and fish; and that the values which they offer are
# those that the program takes. Arguments: the program.
set -euo pipefail
program=$1
. "$(dirname "${BASH_SOURCE[0]}")/../support/shell_test.sh"

for shell in bash zsh fish; do "$program" completion $shell >"$work/$shell"; done
status=0
"$program" completion tcsh 2>"$work/error.txt" || status=$?
[[ $status == 2 && $(cat "$work/error.txt") == "unknown shell 'tcsh': it may be bash, zsh, fish" ]] || fail "tcsh: $(cat "$work/error.txt")"

mkdir -p "$work/files/scenes.d"
cd "$work/files"
touch room.pbrt 'two words.GLB' sky.exr out.png notes.txt

# Prints what is offered for a command line, whose last word is to be completed.
# shellcheck source=/dev/null
source "$work/bash"
bash_offers() {
  COMP_WORDS=("$@")
  COMP_CWORD=$(($# - 1))
  _alhazen || true  # its status means nothing
  printf '%s\n' "${COMPREPLY[@]}"
}
expect() {
  local wanted=$1
  shift
  local offered
  offered=$(bash_offers "$@" | sort | paste -sd'|')
  [[ $offered == "$wanted" ]] || fail "bash offers '$offered' for '$*', not '$wanted'"
}
expect 'render' alhazen rend
expect 'report' alhazen study r
expect 'compare|report|tune' alhazen study ''
expect 'room.pbrt|scenes.d|two words.GLB' alhazen render ''
expect 'room.pbrt' alhazen info ro
expect 'room.pbrt' alhazen ro
expect '--tone-map' alhazen render --tone
expect '--tone-map' alhazen room.pbrt --tone
expect 'aces|agx' alhazen render room.pbrt --tone-map a
expect 'aces|agx' alhazen render room.pbrt --tone-map = a
expect 'aces|agx|filmic|none|reinhard' alhazen render room.pbrt --tone-map =
expect 'depth,albedo|depth,alpha' alhazen render --aov depth,al
expect 'out.png|scenes.d|sky.exr' alhazen render room.pbrt -o ''
expect 'out.png' alhazen render room.pbrt --outfile o
expect 'notes.txt|out.png|room.pbrt|scenes.d|sky.exr|two words.GLB' alhazen render --environment ''
expect 'scenes.d' alhazen render --search-path ''
expect 'auto' alhazen render --denoise a
expect 'room.pbrt' alhazen render --denoise roo
expect '--json' alhazen devices --j
expect '--json' alhazen study compare --j
expect '' alhazen render --spp ''
expect 'bash|fish|zsh' alhazen completion ''
expect '' alhazen nonsense x

# All options of the help are offered, and no others.
for command in '' render compare devices info study 'study report' 'study tune' 'study compare' completion; do
  read -ra words <<<"alhazen $command"
  "$program" "${words[@]:1}" --help-all | sed -n 's/^  \(-[^ ]*\).*/\1/p' | sed 's/{[a-z]*}//g' | tr , '\n' | sort >"$work/help.txt"
  bash_offers "${words[@]}" - | sort >"$work/offered.txt"
  [[ -s $work/help.txt ]] && diff "$work/help.txt" "$work/offered.txt" || fail "options of '$command'"
done

# What the program takes, by its message on a value that it does not know.
values() { bash_offers alhazen "${@:1:$#-1}" "${!#}" '' | sort; }
count=0
expect_values() {
  "$program" "$@" zzz >"$work/message.txt" 2>&1 && fail "'$*' takes zzz"
  sed -n "s/.*\(it may be\|must be one of\|; use\) //p" "$work/message.txt" | sed 's/, with a radius.*//; s/, not .*//; s/the extension of //' |
    sed 's/ or /,/g; s/[. ]//g' | tr , '\n' | sort >"$work/taken.txt"
  [[ -s $work/taken.txt ]] || { cat "$work/message.txt"; fail "the message for '$* zzz' lists no values"; }
  values "$@" >"$work/offered.txt"
  diff "$work/taken.txt" "$work/offered.txt" || fail "values of '$*' (< the program, > the completion)"
  count=$((count + 1))
}
scene=$source/scenes/cornell.pbrt
for option in aov-surface aov backend coats denoise exr-compression exr-type filter guiding integrator precision progress quality \
  sampler schedule stats tone-map; do
  expect_values render "$scene" -q --spp 1 --size 4x4 -o "$work/image.exr" --$option
done
expect_values render "$scene" -q --spp 1 --size 4x4 -o - --format
expect_values study report --only
strategies=auto
for backend in openmp cuda; do
  device=()
  [[ $backend != cuda ]] || device=(--device host)
  "$program" render "$scene" -q --spp 1 --size 4x4 -o "$work/image.exr" --backend $backend "${device[@]}" --strategy zzz 2>"$work/message.txt" ||
    strategies+=,$(sed -n 's/.*it may be //p' "$work/message.txt" | tr -d ' ')
done
values render --strategy | grep -v '^megakernel$' >"$work/offered.txt"
tr , '\n' <<<"$strategies" | sort -u | diff - "$work/offered.txt" || fail "values of --strategy"
echo "values of $count options are those of the program"

# Every option whose value is one of some names has them, unless they are names of the scene or of files.
"$program" render --help-all | sed -n 's/^  .*\(--[a-z-]*\) \[\?NAME.*/\1/p' | grep -vE -- '--(camera|variant|animation|define|light-group)$' |
  while read -r option; do [[ -n $(values render "$option") ]] || fail "$option has no values"; done

if command -v zsh >/dev/null; then
  mkdir "$work/functions"
  cp "$work/zsh" "$work/functions/_alhazen"
  zsh -n "$work/zsh" || fail "zsh cannot parse its script"
  cat >"$work/zpty.zsh" <<'TEXT'
# Prints what zsh shows when Tab is pressed after the text $2; completion functions are in $1.
zmodload zsh/zpty
zpty shell 'zsh -f -i'
zpty -w shell "PS1='ready> '; PS2=; stty columns 200; unsetopt beep; setopt no_auto_menu list_packed; fpath=($1 \$fpath); autoload -Uz compinit; compinit -D -u; zstyle ':completion:*' list-prompt ''; LISTMAX=0; echo be''gun"
local text all=
while zpty -r shell text; do [[ $text == *begun* ]] && break; done
zpty -n -w shell "$2"$'\t\t'
integer end=$((SECONDS + 3))
while (( SECONDS < end )); do zpty -rt shell text && all+=$text || sleep 0.1; done
zpty -d shell
print -r -- $all
TEXT
  zsh_offers() {
    zsh -f "$work/zpty.zsh" "$work/functions" "$1" >"$work/zsh.txt" 2>&1
    for word in "${@:2}"; do
      grep -qF -- "$word" "$work/zsh.txt" || { cat -v "$work/zsh.txt"; fail "zsh does not offer '$word' for '$1'"; }
    done
    ! grep -qE 'notes.txt|_arguments:|command not found|bad ' "$work/zsh.txt" || { cat -v "$work/zsh.txt"; fail "zsh: '$1'"; }
  }
  zsh_offers 'alhazen render --tone-map ' reinhard filmic aces
  zsh_offers 'alhazen render --tone' --tone-map
  zsh_offers 'alhazen study ' report tune compare
  zsh_offers 'alhazen render ' room.pbrt 'two\ words.GLB' scenes.d
  zsh_offers 'alhazen room.pbrt --transparent-' background glass
  zsh_offers 'alhazen render --aov depth,alb' depth,albedo
  echo "zsh completes"
else
  echo "zsh is not installed: its completion is not tried"
fi

if command -v fish >/dev/null; then
  fish_offers() {
    HOME=$work fish --no-config -c "source $work/fish; complete -C '$1'" | cut -f1 | sort | paste -sd'|' >"$work/fish.txt"
    [[ $(cat "$work/fish.txt") == "$2" ]] || fail "fish offers '$(cat "$work/fish.txt")' for '$1', not '$2'"
  }
  fish_offers 'alhazen rend' render
  fish_offers 'alhazen study ' 'compare|report|tune'
  fish_offers 'alhazen render --tone-map a' 'aces|agx'
  fish_offers 'alhazen room.pbrt --tone-map=a' '--tone-map=aces|--tone-map=agx'
  fish_offers 'alhazen render --tone' --tone-map
  fish_offers 'alhazen info ' 'room.pbrt|scenes.d/|two words.GLB'
  fish_offers 'alhazen render --aov depth,alb' depth,albedo
  fish_offers 'alhazen completion ' 'bash|fish|zsh'
  echo "fish completes"
else
  echo "fish is not installed: its completion is not tried"
fi
