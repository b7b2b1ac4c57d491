# SPDX-License-Identifier: MIT
"""What the scripts on the corpus share: the truth, pictures, contact sheets."""
import csv
import os

from PIL import Image, ImageDraw

HERE = os.path.dirname(os.path.abspath(__file__))
CORPUS = os.environ.get('CORPUS', 'build/corpus')


def path_of(name):
    return os.path.join(CORPUS, name + '.ppm')


def size_of(name):
    """Width and height in pixels."""
    return Image.open(path_of(name)).size


def truth(half):
    """Pictures in the order of the file: name -> kind, lamps."""
    pictures = {}
    with open(os.path.join(HERE, 'truth.csv'), newline='') as table:
        for row in csv.DictReader(table):
            if half not in ('all', row['half']):
                continue
            if not os.path.exists(path_of(row['file'])):
                continue  # of an npm package, where there is no npm
            lamps = pictures.setdefault(row['file'], (row['kind'], []))[1]
            if row['lamp'] != 'none':
                lamps.append((row['lamp'], float(row['x']), float(row['y']),
                              float(row['radius'])))
    return pictures


def sheet(cells, path, side=400, columns=4, height=300):
    """A JPEG of cells: (text below, picture of at most side x height)."""
    rows = (len(cells) + columns - 1) // columns
    tall = height + 16
    page = Image.new('RGB', (columns * side, rows * tall), (50, 50, 50))
    draw = ImageDraw.Draw(page)
    for k, (text, picture) in enumerate(cells):
        x, y = k % columns * side, k // columns * tall
        page.paste(picture, (x, y))
        draw.text((x + 2, y + tall - 14), text, fill=(255, 255, 255))
    os.makedirs(os.path.dirname(path) or '.', exist_ok=True)
    page.save(path, quality=88)
