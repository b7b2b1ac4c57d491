# SPDX-License-Identifier: MIT
"""pairs.py IN.ppm FOLDER COUNT - pictures with and without a flare, for a program that learns to tell them apart. Each
pair follows from its number alone."""
import pathlib
import sys

import glint
import numpy as np
from ppm import read, write

clean, folder = read(sys.argv[1]), pathlib.Path(sys.argv[2])
folder.mkdir(exist_ok=True)
engine = glint.Engine("heliar-tronnier", *clean.shape[:2], quality=0.25)
for i in range(int(sys.argv[3])):
    draw = np.random.default_rng(i)
    x, y = draw.uniform((0, 0), clean.shape[1::-1])
    flared = clean.copy()
    engine.overlay(flared, [engine.lamp_at(x, y, draw.uniform(14, 18))])
    write(folder / f"{i:04d}.clean.ppm", clean)
    write(folder / f"{i:04d}.flare.ppm", flared)
    print(f"{i}: a light at {x:.0f},{y:.0f}, {np.mean(flared != clean):.0%} of the codes changed")
