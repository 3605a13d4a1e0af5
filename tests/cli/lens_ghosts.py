#!/usr/bin/env python3
"""Ghosts of two lenses with random coatings, some of which absorb, by `cuvette lens report` and by characteristic
matrices (Macleod, Thin-Film Optical Filters, on assemblies of thin films): R and R' of the two surfaces and T of all
that the light passes. lens_ghosts.py PROGRAM FOLDER; prints the compared ghosts and the largest relative difference."""
import cmath
import json
import math
import random
import subprocess
import sys

program, folder = sys.argv[1:]
number = random.Random(11)


def power(before, stack, after, nm):
    """R and T at normal incidence of layers (index, nm), the first of which the light meets first."""
    b, c = 1.0, after
    for n, thickness in reversed(stack):
        phase = 2.0 * math.pi * n * thickness / nm
        cosine, sine = cmath.cos(phase), 1j * cmath.sin(phase)
        b, c = cosine * b + sine * c / n, n * sine * b + cosine * c
    r = (before * b - c) / (before * b + c)
    return abs(r) ** 2, 4.0 * before * after / abs(before * b + c) ** 2


def ghosts(surfaces, nm):
    """By (second surface, first surface): the part of the light. surfaces: (n, stack, n after)."""
    forth = [power(*s, nm) for s in surfaces]
    back = [power(after, stack[::-1], before, nm)[0] for before, stack, after in surfaces]
    found = {}
    for j in range(1, len(surfaces)):
        for i in range(j):
            weight = math.prod(t for _, t in forth[:j]) * forth[j][0] * back[i]
            weight *= math.prod(t for _, t in forth[i + 1 : j])
            found[i + 1, j + 1] = weight * math.prod(t for _, t in forth[i + 1 :])
    return found


compared, worst = 0, 0.0
for case in range(6):
    nm = round(number.uniform(450.0, 650.0), 1)
    lenses = []
    for n in (1.5, 1.7):
        k_most = 0.5 if case % 2 else 0.0
        stack = [
            (
                complex(round(number.uniform(1.3, 2.3), 3), -round(number.uniform(0.0, k_most), 3)),
                number.randint(10, 120),
            )
            for _ in range(number.randint(1, 3))
        ]
        lenses.append((n, stack))
    with open(f"{folder}/ghosts.yaml", "w", encoding="ascii") as scene:
        scene.write(f"render: {{unit_m: 0.001, lambda_nm: {nm}}}\nmaterials:\n")
        for name, (n, stack) in zip(("glass-1-5", "glass-1-7"), lenses):
            layers = ", ".join(
                f"{layer.real}+{-layer.imag}i {d}" if layer.imag else f"{layer.real} {d}" for layer, d in stack
            )
            scene.write(f'  {name}: {{transparency: 1, ior: {n}, coating: "{layers}"}}\n')
        scene.write(
            "background: {ior: 1}\nlens_systems:\n  objective:\n    pupil: 5\n    surfaces:\n"
            "      - {radius: 60, thickness: 4, medium: 1.5, diameter: 20, stop: on}\n"
            "      - {radius: -200, thickness: 3, diameter: 20}\n"
            "      - {radius: 80, thickness: 3, medium: 1.7, diameter: 20}\n"
            "      - {radius: 0, thickness: 0, diameter: 20}\n"
        )
    words = ("--json", "--spot", "4", "--wave", "8", "--fan", "2", f"{folder}/ghosts.yaml")
    done = subprocess.run([program, "lens", "report", *words], check=True, capture_output=True)
    rows = json.loads(done.stdout)["sections"]["ghosts"]["values"]
    surfaces = []
    for n, stack in lenses:
        surfaces += [(1.0, stack, n), (n, stack[::-1], 1.0)]
    expected = ghosts(surfaces, nm)
    for x, surface, weight in zip(rows["x"], rows["surface"], rows["weight"]):
        value = expected[int(x), int(surface)]
        worst = max(worst, abs(weight - value) / value)
        compared += 1
print(f"{compared} {worst:.3g}")
