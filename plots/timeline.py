#!/usr/bin/env -S python3 -B
"""The tiles of a frame from its timeline (Chrome trace JSON): begin and end in ms, worker, and the tile's position in
the image in reading order (0 first, 1 last).

  plots/timeline.py TIMELINE.json [GAP]

With GAP, tiles of one worker that follow within GAP ms are one, with their mean position: a thousand workers have more
tiles than a figure has pixels.
"""

import json
import re
import sys


def tiles_of(path):
    """In reading order; the name of a tile is its corner: "32,64-..." or "tile 32,64"."""
    with open(path, encoding="utf-8") as file:
        events = [event for event in json.load(file)["traceEvents"] if event["ph"] == "X"]
    corner = [[int(number) for number in re.findall(r"\d+", event["name"])[1::-1]] for event in events]
    order = sorted(range(len(events)), key=lambda i: corner[i])
    for place, event in enumerate(events[i] for i in order):
        position = place / (len(events) - 1) if len(events) > 1 else 0
        yield event["ts"] / 1e3, (event["ts"] + event["dur"]) / 1e3, event["tid"], position


def joined(tiles, gap_ms):
    begin, end, worker, places = 0, 0, None, []
    for next_begin, next_end, next_worker, place in sorted(tiles, key=lambda tile: (tile[2], tile[0])):
        if places and (next_worker != worker or next_begin - end > gap_ms):
            yield begin, end, worker, sum(places) / len(places)
            places = []
        if not places:
            begin, worker = next_begin, next_worker
        end = next_end
        places.append(place)
    if places:
        yield begin, end, worker, sum(places) / len(places)


found = tiles_of(sys.argv[1])
for line in joined(found, float(sys.argv[2])) if len(sys.argv) > 2 else found:
    print(*(f"{number:.6g}" for number in line))
