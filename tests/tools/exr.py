#!/usr/bin/env python3
# Reads OpenEXR files of 32-bit floats in scan lines, uncompressed or ZIP ("OpenEXR File Layout", openexr.com), with
# Python's standard library alone.
#   exr.py names FILE                      the names of the channels
#   exr.py text FILE NAME                  a text attribute
#   exr.py attributes FILE                 names and types of the attributes
#   exr.py sum FILE CHANNEL                the sum of a channel
#   exr.py near FILE A,B,C LIMIT FACTOR PFM [FACTOR PFM]...   whether they are within LIMIT of the sum of PFMs
#   exr.py same FILE A,B,C PFM             whether the channels are those of a PFM, bit for bit; one name: its red
import math
import struct
import sys
import zlib

ZIP, LINES = 3, {0: 1, 2: 1, 3: 16}


def text_at(data, at):
    end = data.index(0, at)
    return data[at:end].decode(), end + 1


def header(data):
    magic, version = struct.unpack_from("<II", data)
    assert magic == 20000630 and version & ~0x400 == 2, "not a plain OpenEXR file"
    at, found = 8, {}
    while data[at]:
        name, at = text_at(data, at)
        kind, at = text_at(data, at)
        (size,) = struct.unpack_from("<i", data, at)
        found[name] = (kind, data[at + 4:at + 4 + size])
        at += 4 + size
    return found, at + 1


def channels(attributes):
    data, at, names = attributes["channels"][1], 0, []
    while data[at]:
        name, at = text_at(data, at)
        assert struct.unpack_from("<i", data, at) == (2,), "not of floats"
        names.append(name)
        at += 16
    return names


def unpack(packed, size):
    if len(packed) == size:
        return packed
    sums = bytearray(zlib.decompress(packed))
    for i in range(1, size):
        sums[i] = sums[i - 1] + sums[i] - 128 & 255
    out = bytearray(size)
    out[0::2], out[1::2] = sums[:(size + 1) // 2], sums[(size + 1) // 2:]
    return bytes(out)


def read(path):
    """Width, height, and a list of values for each channel, from the top."""
    with open(path, "rb") as file:
        data = file.read()
    attributes, at = header(data)
    names = channels(attributes)
    x0, y0, x1, y1 = struct.unpack("<4i", attributes["dataWindow"][1])
    width, height, lines = x1 - x0 + 1, y1 - y0 + 1, LINES[attributes["compression"][1][0]]
    values = {name: [] for name in names}
    for first in range(0, height, lines):
        (place,) = struct.unpack_from("<Q", data, at + 8 * (first // lines))
        y, size = struct.unpack_from("<ii", data, place)
        assert y == first + y0
        count = min(lines, height - first)
        raw = unpack(data[place + 8:place + 8 + size], count * width * 4 * len(names))
        numbers = struct.unpack("<%df" % (count * width * len(names)), raw)
        for line in range(count):
            for i, name in enumerate(names):
                start = (line * len(names) + i) * width
                values[name].extend(numbers[start:start + width])
    return width, height, values


def read_pfm(path):
    with open(path, "rb") as file:
        kind, size, scale = file.readline(), file.readline(), float(file.readline())
        width, height = map(int, size.split())
        assert kind == b"PF\n" and scale < 0
        numbers = struct.unpack("<%df" % (3 * width * height), file.read())
    rows = [numbers[3 * width * y:3 * width * (y + 1)] for y in range(height)]
    return width, height, [value for row in reversed(rows) for value in row]


def same(path, names, pfm):
    width, height, values = read(path)
    wanted = read_pfm(pfm)
    if wanted[:2] != (width, height):
        return False
    return all(struct.pack("<%df" % (width * height), *values[name]) ==
               struct.pack("<%df" % (width * height), *wanted[2][i::3]) for i, name in enumerate(names.split(",")))


def near(path, names, limit, *terms):
    values = read(path)[2]
    films = [(float(factor), read_pfm(pfm)[2]) for factor, pfm in zip(terms[0::2], terms[1::2])]
    worst = 0.0
    for i, name in enumerate(names.split(",")):
        for k, value in enumerate(values[name]):
            worst = max(worst, abs(value - sum(factor * film[3 * k + i] for factor, film in films)))
    print("%.3g" % worst)
    return worst <= float(limit)


def main():
    what, path, *rest = sys.argv[1:]
    if what == "same":
        return 0 if same(path, *rest) else 1
    if what == "near":
        return 0 if near(path, *rest) else 1
    if what == "sum":
        print("%.17g" % math.fsum(read(path)[2][rest[0]]))
        return 0
    with open(path, "rb") as file:
        attributes, _ = header(file.read())
    if what == "names":
        print(*channels(attributes))
    elif what == "text":
        print(attributes[rest[0]][1].decode(), end="")
    else:
        print(*("%s:%s" % (name, kind) for name, (kind, _) in attributes.items()))
    return 0


if __name__ == "__main__":
    sys.exit(main())
