#!/usr/bin/env bash
# Writes a manual page in man(7) to standard output, from the program's own help.
# Arguments: the program, and the words of a subcommand, if the page is about one.
set -euo pipefail
program=$1
shift
name="alhazen${*:+ $*}"
version=$("$program" --version | sed -n '1s/^alhazen //p')
date=$(date -u -d "@${SOURCE_DATE_EPOCH:-$(date +%s)}" +%Y-%m-%d)

"$program" "$@" --help-all | awk -v name="$name" -v version="$version" -v date="$date" '
  # Text as it is, in running lines: of requests, escapes and dashes nothing is left.
  function plain(text) {
    gsub(/\\/, "\\e", text)
    gsub(/-/, "\\-", text)
    sub(/^[.\047]/, "\\\\\\&&", text)
    return text
  }
  # Sentences begin lines, as troff wants them.
  function running(text) {
    gsub(/  +/, " ", text)
    while (match(text, /[.] [A-Z]/)) {
      print plain(substr(text, 1, RSTART))
      text = substr(text, RSTART + 2)
    }
    if (text != "") print plain(text)
  }
  function section(title) { flush(); print ".SH " toupper(title); begins = 1 }
  function flush() {
    if (term != "") {
      print ".TP"
      # Names in bold, what they need in italics.
      space = index(term, " ")
      if (space == 0) print ".B " plain(term)
      else print ".BI \"" plain(substr(term, 1, space - 1)) "\" \" " plain(substr(term, space + 1)) "\""
      if (body != "") running(body)
    } else if (body != "") {
      if (!begins) print ".PP"
      running(body)
    }
    if (term != "" || body != "") begins = 0
    term = body = ""
  }
  NR == 1 { summary = $0 }
  NR > 1 && !usage && !/^Usage: / { summary = summary " " $0 }
  /^Usage: / {
    usage = 1
    title = name
    gsub(/ /, "-", title)
    page = title
    print ".\\\" Written by scripts/man-page.sh from alhazen --help-all."
    printf ".TH %s 1 %s \"Alhazen %s\" \"User Commands\"\n", toupper(plain(title)), date, version
    print ".SH NAME"
    sub(/[.]$/, "", summary)
    print plain(page) " \\- " plain(summary)
    print ".SH SYNOPSIS"
    words = $0
    sub(/^Usage: /, "", words)
    sub("^" name, "", words)
    sub(/^ /, "", words)
    print ".B " plain(name)
    print plain(words)
    next
  }
  !usage { next }
  /^[A-Z][A-Za-z ]*:$/ { section(substr($0, 1, length($0) - 1)); headed = 1; next }
  /^Exit codes: / { section("exit status"); headed = 1; body = substr($0, 13); next }
  /^\047.*SUBCOMMAND --help/ { flush(); next }
  /^$/ { flush(); next }
  /^  [^ ]/ {
    flush()
    if (!headed) { section("arguments"); headed = 1 }
    line = substr($0, 3)
    if (match(line, /  +/)) {
      term = substr(line, 1, RSTART - 1)
      body = substr(line, RSTART + RLENGTH)
    } else {
      term = line
    }
    next
  }
  { sub(/^ +/, ""); body = body (body == "" ? "" : " ") $0 }
  END { flush() }
'
if (($# > 0)); then
  printf '.SH SEE ALSO\n.BR alhazen (1)\n'
else
  printf '.SH SEE ALSO\n'
  "$program" --help-all | sed -n '/^Subcommands:/,/^$/s/^  \([a-z][a-z]*\) .*/.BR alhazen\\-\1 (1)/p' |
    sed '$!s/(1)$/(1),/'
fi
