#!/usr/bin/env -S python3 -B
"""Print values of a JSON object on standard input, a line each: json_value.py rays.camera kernel.-1 ..."""

import functools
import json
import sys

found = json.load(sys.stdin)
for path in sys.argv[1:]:
    print(functools.reduce(lambda at, key: at[int(key)] if isinstance(at, list) else at[key], path.split("."), found))
