"""Random coatings against an independent program: `cuvette trace --beams --json` on a coated plate, and the recursion
of Fresnel's coefficients (Rouard; Macleod, Thin-Film Optical Filters, 2.5) in Python's complex numbers. Prints the
number of compared surfaces and the largest difference of R_s, R_p and T. coatings.py PROGRAM FOLDER"""

import cmath
import json
import math
import random
import subprocess
import sys

program, folder = sys.argv[1:]
number = random.Random(53)


def power(ends, stack, lambda_nm, sine, polarisation):
    """R and T of light from ends[0] through layers (index, nm) into ends[1]; sine: n sin(angle)."""
    indices = [complex(ends[0])] + [n for n, _ in stack] + [complex(ends[1])]
    cosines = [cmath.sqrt(1 - (sine / n) ** 2) for n in indices]
    cosines = [-c if (n * c).imag < 0 else c for n, c in zip(indices, cosines)]
    q = [n * c if polarisation == "s" else c / n for n, c in zip(indices, cosines)]
    r, t = 0, 1
    for i in reversed(range(len(indices) - 1)):
        layer = i + 1 < len(indices) - 1
        phase = 2 * math.pi * indices[i + 1] * cosines[i + 1] * stack[i][1] / lambda_nm if layer else 0
        wave, first = cmath.exp(1j * phase), (q[i] - q[i + 1]) / (q[i] + q[i + 1])
        divisor = 1 + first * r * wave**2
        t = 2 * q[i] / (q[i] + q[i + 1]) * t * wave / divisor
        r = (first + r * wave**2) / divisor
    return abs(r) ** 2, abs(t) ** 2 * q[-1].real / q[0].real


def compare(hit, stack, lambda_nm):
    ends = hit["from"]["n"], hit["to"]["n"]
    sine = ends[0] * math.sqrt(1 - hit["cos_i"] ** 2)
    of_s, of_p = (power(ends, stack, lambda_nm, sine, p) for p in "sp")
    expected = of_s[0], of_p[0], (of_s[1] + of_p[1]) / 2
    return max(abs(hit[name] - value) for name, value in zip(("R_s", "R_p", "T"), expected))


compared, worst = 0, 0.0
for case in range(40):
    k_most = (0, 0.2, 5)[case % 3]
    kinds = [complex(number.uniform(1.2, 2.6), number.uniform(0, k_most)) for _ in range(number.randint(1, 4))]
    stack = [(number.choice(kinds), number.uniform(5, 300 if k_most < 1 else 25)) for _ in range(number.randint(1, 12))]
    written = ", ".join(f"{n.real!r}+{n.imag!r}i {d!r}" if n.imag else f"{n.real!r} {d!r}" for n, d in stack)
    lambda_nm, ior = number.uniform(400, 750), number.uniform(1.2, 1.9)
    if len(written) > 255:
        stack, written = stack[:3], ", ".join(written.split(", ")[:3])
    beams = "".join(
        f"  b{i}: {{position: [0, 3, 0], direction: [{math.sin(a)!r}, {-math.cos(a)!r}, 0], "
        f"lambda_nm: {lambda_nm!r}}}\n"
        for i, a in enumerate(number.uniform(0, 1.5) for _ in range(8))
    )
    with open(f"{folder}/plate.yaml", "w", encoding="ascii") as scene:
        scene.write(
            f"render: {{depth: 2}}\nbeams:\n{beams}solids:\n  plate: {{shape: box, size: [999, 1, 999], "
            f'transparency: 1, ior: {ior!r}, coating: "{written}"}}\n'
        )
    command = [program, "trace", f"{folder}/plate.yaml", "--beams", "--json"]
    for beam in json.loads(subprocess.run(command, check=True, capture_output=True).stdout)["beams"]:
        top = beam["rays"][0]["root"]
        worst = max(worst, compare(top["hit"], stack, lambda_nm))
        compared += 1
        for child in top["children"]:
            if child["kind"] == "refract" and child["hit"]:
                worst = max(worst, compare(child["hit"], stack[::-1], lambda_nm))
                compared += 1
print(compared, worst)
