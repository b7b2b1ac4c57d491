# SPDX-License-Identifier: MIT
#
# pairs.py - items of glint synth as tensors, and flares whose geometry is broken.
#
# Light is linear, 1 = white; its root is what a network sees and what errors count
# in, as it is cheap and nearly as even to the eye as codes of sRGB.
import json
import os

import numpy
import torch
import torch.nn.functional as F

CODES = torch.arange(256) / 255
LIGHT = torch.where(CODES <= 0.04045, CODES / 12.92, ((CODES + 0.055) / 1.055) ** 2.4)  # of codes of sRGB


def encode(light):
    """Codes of light, 0 to 1."""
    light = light.clamp(0, 1)
    return torch.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)


def decode(codes):
    return LIGHT[codes.long()]


def picture(path):
    """A binary PPM of 8 bits as [3, height, width]."""
    with open(path, 'rb') as file:
        head = file.readline(), file.readline(), file.readline()
        width, height = map(int, head[1].split())
        if head[0] != b'P6\n' or head[2] != b'255\n':
            raise SystemExit('%s: is no PPM as glint synth writes it' % path)
        data = numpy.frombuffer(file.read(), numpy.uint8)
    return torch.from_numpy(data.reshape(height, width, 3).transpose(2, 0, 1).copy())


class Pairs:
    """All items of a set in the layout bracketflare."""

    def __init__(self, folder, count):
        with open(os.path.join(folder, 'manifest.jsonl')) as file:
            self.lines = [json.loads(line) for line in file][:count]

        def load(kind):
            return torch.stack([picture('%s/test/%s/%06d.ppm' % (folder, kind, line['item']))
                                for line in self.lines])
        self.input, self.truth, self.flare, self.mask = map(load, ('lq', 'gt', 'flare', 'mask'))
        self.noise = torch.tensor([[line['read_noise'], line['full_well']] for line in self.lines])
        self.spokes = torch.stack([spokes(line) for line in self.lines])

    def __len__(self):
        return len(self.lines)


def spokes(line):
    """[3, height, width]: how near a pixel is to the line from a light through
    the middle, along which ghosts of round lenses lie, of the nearest such; how
    far along that line it is, 1 at the light and -1 across the middle; and how
    far off it."""
    width, height = int(line['width']), int(line['height'])
    y, x = torch.meshgrid((torch.arange(height) + 0.5) / height - 0.5,
                          ((torch.arange(width) + 0.5) / width - 0.5) * width / height, indexing='ij')
    off, along = [], []
    for light in line['lights']:
        u, v = (light['x'] - 0.5) * width / height, light['y'] - 0.5
        size = max((u * u + v * v) ** 0.5, 0.02)
        off.append((x * v - y * u).abs() / size)
        along.append((x * u + y * v) / size ** 2)
    off, along = torch.stack(off), torch.stack(along).clamp(-3, 3)
    least, which = off.min(0)
    return torch.stack([torch.exp(-0.5 * (least / 0.04) ** 2), along.gather(0, which[None])[0] / 3, least])


def moved(flare, breaks, random):
    """FLARE, light, under an affine map about the middle, another one for each:
    of BREAKS any turn, scales of 0.75 to 1.33 a side and a shift of a quarter;
    else a shift of half a pixel at most, which softens it as much. What comes
    from beside the picture is its mirror image, without an edge."""
    n, _, height, width = flare.shape

    def even(low, high):
        return torch.rand(n, generator=random) * (high - low) + low
    turn, shear = even(-numpy.pi, numpy.pi), even(-numpy.pi, numpy.pi)
    scale = torch.exp(even(-0.29, 0.29)), torch.exp(even(-0.29, 0.29))
    shift = even(-0.5, 0.5), even(-0.5, 0.5)
    if breaks:
        def rotation(a):
            return torch.stack([torch.cos(a), -torch.sin(a), torch.sin(a), torch.cos(a)], 1).view(n, 2, 2)
        linear = rotation(turn) @ torch.diag_embed(torch.stack(scale, 1)) @ rotation(shear)
        offset = torch.stack(shift, 1)
    else:
        linear = torch.eye(2).expand(n, 2, 2)
        offset = torch.stack([2 * shift[0] / width, 2 * shift[1] / height], 1)
    grid = F.affine_grid(torch.cat([linear, offset[:, :, None]], 2), list(flare.shape), align_corners=False)
    return F.grid_sample(flare, grid, padding_mode='reflection', align_corners=False)


def batch(pairs, which, breaks, random):
    """Light of input, truth and flare of the items WHICH to learn from, their
    masks and spokes: the flare, moved, added to the truth, noise of the item's
    sensor added, then clipped; everything then turned and mirrored as a whole,
    which keeps the geometry."""
    truth = decode(pairs.truth[which])
    flare = moved(decode(pairs.flare[which]), breaks, random)
    read, well = (pairs.noise[which, k].view(-1, 1, 1, 1) for k in (0, 1))
    light = truth + flare
    light = (light + torch.randn(light.shape, generator=random) * (light / well + read ** 2).sqrt()).clamp(0, 1)
    all_of = [light, truth, flare.clamp(0, 1), pairs.mask[which, :1] / 255, pairs.spokes[which]]
    k = int(torch.randint(8, (1,), generator=random))
    for i, one in enumerate(all_of):
        one = torch.rot90(one, k % 4, (2, 3))
        all_of[i] = one.flip(3) if k > 3 else one
    return all_of


def whole(pairs, which):
    """The same of items to test with, as glint synth wrote them."""
    return [decode(pairs.input[which]), decode(pairs.truth[which]), decode(pairs.flare[which]),
            pairs.mask[which, :1] / 255, pairs.spokes[which]]
