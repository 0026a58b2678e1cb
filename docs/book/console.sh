#!/usr/bin/env bash
# Runs the commands that the chapters show and compares what they print with the text; `--write` puts it there. Needs awk.
#
#   docs/book/console.sh [--write] [CHAPTER.md ...]
#
# A block ```toml whose first line is `# file: NAME` is saved as NAME. In a block ```console each line that begins with `$ ` is run, in one
# folder per chapter that has the project's `scenes/`; the lines after it are its output. ROCKING names the program
# (default: target/release/rocking).
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
program=$(realpath "${ROCKING:-$root/target/release/rocking}")
write=false
if [ "${1:-}" = --write ]; then write=true; shift; fi
if [ $# = 0 ]; then set -- $(grep -l '^```console$' "$root"/docs/book/*.md); fi
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir "$scratch/bin"
ln -s "$program" "$scratch/bin/rocking"
export PATH="$scratch/bin:$PATH"
status=0
for chapter in "$@"; do
    folder="$scratch/$(basename "$chapter" .md)"
    mkdir "$folder"
    ln -s "$root/scenes" "$folder/scenes"
    block= file=
    while IFS= read -r line; do
        case "$block:$line" in
            :'```toml') block=toml ;;
            :'```console') block=console ;;
            :'```'*) block=other ;;
            *:'```') block= file= ;;
            toml:'# file: '*) file="$folder/${line#\# file: }"; printf '%s\n' "$line" > "$file" ;;
            toml:*) if [ -n "$file" ]; then printf '%s\n' "$line" >> "$file"; fi ;;
            console:'$ '*)
                printf '%s\n' "$line"
                (cd "$folder" && bash -c "${line#\$ }" 2>&1 < /dev/null) | awk 1 | sed 's/[[:space:]]*$//' || true
                continue ;;
            console:*) continue ;;
        esac
        printf '%s\n' "$line"
    done < "$chapter" > "$folder.md"
    if $write; then
        cp "$folder.md" "$chapter"
    elif ! diff -u "$chapter" "$folder.md"; then
        status=1
    fi
done
exit $status
