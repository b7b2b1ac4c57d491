# SPDX-License-Identifier: MIT
"""PPM of 8 bits, for examples without further packages."""
import numpy as np


def read(path):
    with open(path, "rb") as file:
        data = file.read()
    kind, width, height, most, _ = data.split(None, 4)
    assert kind == b"P6" and most == b"255", "a binary PPM of 8 bits"
    width, height = int(width), int(height)
    return np.frombuffer(data[-3 * width * height:], np.uint8).reshape(height, width, 3).copy()


def write(path, array):
    with open(path, "wb") as file:
        file.write(b"P6\n%d %d\n255\n" % (array.shape[1], array.shape[0]))
        file.write(np.ascontiguousarray(array).tobytes())
