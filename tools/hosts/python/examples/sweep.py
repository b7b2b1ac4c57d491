# SPDX-License-Identifier: MIT
"""sweep.py OUT.ppm [LENS] - a light that crosses the picture, and how much light its ghosts give: six pictures beside
each other, and a line for each."""
import sys

import glint
import numpy as np
from ppm import write

lens = sys.argv[2] if len(sys.argv) > 2 else "heliar-tronnier"
engine = glint.Engine(lens, 180, 270, exposure=0.0, starburst=0.0, quality=0.25)
strip = []
for theta in range(0, 30, 5):
    light = engine.render([glint.Lamp(theta, 33, 3e5)])
    print(f"{theta:3d} degrees: {light.mean():.3e} of white in the mean, {light.max():.3e} at most")
    strip.append(np.uint8(np.clip(light, 0, 1) ** (1 / 2.2) * 255 + 0.5))
write(sys.argv[1], np.hstack(strip))
