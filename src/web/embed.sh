#!/bin/bash
# src/web/embed.sh FOLDER FILE...: prints a C file that embeds these files of FOLDER and defines the table of lab.h,
# with their paths in FOLDER. The assembler's .incbin reads the bytes; gcc and clang accept the same directive.
set -euo pipefail
declare -A types=([html]='text/html; charset=utf-8' [css]='text/css; charset=utf-8'
    [js]='text/javascript; charset=utf-8' [json]='application/json' [svg]='image/svg+xml'
    [jpg]='image/jpeg')

echo '#include "web/lab.h"'
folder=$1 number=0 rows=
shift
for file in "$@"; do
    name=${file#"$folder/"} size=$(stat -c %s "$file")
    type=${types[${name##*.}]-}
    [[ $type && $name =~ ^([a-z0-9_-]+/)*[a-z0-9_.-]+$ ]] || {
        echo "embed.sh: $file is not an html, css, js, json, svg or jpg file with a plain name" >&2
        exit 1
    }
    echo "__asm__(\".pushsection .rodata\\npage_file_$number: .incbin \\\"$file\\\"\\n.byte 0\\n.popsection\");"
    echo "extern const unsigned char page_file_$number[] __attribute__((visibility(\"hidden\")));"
    rows+="    {\"$name\", \"$type\", page_file_$number, $size},"$'\n'
    number=$((number + 1))
done
printf 'const http_file page_files[] = {\n%s};\nconst size_t page_file_count = %d;\n' "$rows" "$number"
