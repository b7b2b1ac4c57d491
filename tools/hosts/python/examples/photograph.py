# SPDX-License-Identifier: MIT
"""photograph.py IN.ppm OUT.ppm [LENS] - the flare of the lamps in a photograph, and where these are."""
import sys

import glint
from ppm import read, write

picture = read(sys.argv[1])
lens = sys.argv[3] if len(sys.argv) > 3 else "heliar-tronnier"
engine = glint.Engine(lens, *picture.shape[:2])
report = engine.overlay(picture)
for lamp in report.lamps:
    x, y = engine.place_of(lamp)
    print(f"lamp at {x:.0f},{y:.0f}, {lamp.theta:.1f} degrees off the axis, of {lamp.power:.3g} times white")
print(f"{report.ghosts} ghosts drawn")
write(sys.argv[2], picture)
