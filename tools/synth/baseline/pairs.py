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
TURNS = 8  # ways in which a square lies on itself


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


def halved(light):
    """Means of 2 x 2 pixels, for a network that learns in minutes."""
    return F.avg_pool2d(light, 2)


def pictures(folder, lines):
    """Light of the pictures of LINES, halved, as half floats."""
    return torch.cat([halved(decode(picture('%s/%06d.ppm' % (folder, line['item']))[None])).half()
                      for line in lines])


def masks(folder, lines):
    """How much of each pixel lights cover, which a file holds as it is."""
    return torch.stack([halved(picture('%s/%06d.ppm' % (folder, line['item']))[:1] / 255).half()
                        for line in lines])


def manifest(folder, count):
    with open(os.path.join(folder, 'manifest.jsonl')) as file:
        return [json.loads(line) for line in file][:count]


class Pairs:
    """All items of a set in the layout bracketflare, to test with."""

    def __init__(self, folder, count=10 ** 6):
        self.lines = manifest(folder, count)
        self.input, self.truth, self.flare = (pictures('%s/test/%s' % (folder, kind), self.lines)
                                              for kind in ('lq', 'gt', 'flare'))
        self.mask = masks(folder + '/test/mask', self.lines)
        self.place = torch.stack([place(line) for line in self.lines])

    def __len__(self):
        return len(self.lines)

    def batch(self, which):
        """Light of input, truth and flare of the items WHICH, their masks and
        places."""
        return [one[which].float() for one in (self.input, self.truth, self.flare, self.mask, self.place)]


BREAKS = ('affine', 'lights')


class Lessons:
    """Flares of a set in the layout bracketflare and scenes of one in wu2021, to
    learn from: each flare is put before another scene each time. BREAKS, one of the
    above or None, says how geometry is broken: each flare under a map of its own,
    or as it is, with the lights of the next item."""

    def __init__(self, folder, scenes, count, breaks):
        self.lines = manifest(folder, count)
        flare = pictures(folder + '/test/flare', self.lines)
        self.flare = torch.cat([moved(some, breaks == 'affine', 50 * k) for k, some in enumerate(flare.split(50))])
        self.mask = masks(folder + '/test/mask', self.lines)
        self.place = torch.stack([place(line) for line in self.lines])
        if breaks == 'lights':
            self.mask, self.place = self.mask.roll(-1, 0), self.place.roll(-1, 0)
        self.noise = torch.tensor([[line['read_noise'], line['full_well']] for line in self.lines])
        self.scene = pictures(scenes + '/scenes', manifest(scenes, 10 ** 6))

    def __len__(self):
        return len(self.lines)

    def batch(self, which, random):
        """As of Pairs: a scene, lights before it, the flare added, a quarter to
        1.4 times as bright, noise of the item's sensor, then
        clipped; everything then turned and mirrored as a whole, which keeps the
        geometry."""
        n = len(which)
        scene = self.scene[torch.randint(len(self.scene), (n,), generator=random)].float()
        mask = self.mask[which].float()
        gain = torch.exp2(2.5 * torch.rand(n, generator=random) - 2).view(-1, 1, 1, 1)
        flare = self.flare[which].float() * gain
        truth = torch.where(mask > 0, torch.ones(()), scene)  # lights that flare are far above white
        read, well = (self.noise[which, k].view(-1, 1, 1, 1) for k in (0, 1))
        light = truth + flare
        noise = (light / well + read ** 2).sqrt() / 2  # of means of 4 pixels
        light = (light + torch.randn(light.shape, generator=random) * noise).clamp(0, 1)
        k = int(torch.randint(TURNS, (1,), generator=random))
        return [turned(one, k) for one in (light, truth, flare.clamp(0, 1), mask, self.place[which])]


def turned(one, k):
    one = torch.rot90(one, k % 4, (2, 3))
    return one.flip(3) if k > 3 else one


def place(line):
    """[6, height, width], the same however picture and lights are turned or
    mirrored: how far off the line a pixel is that runs from a light through the
    middle, along which the ghosts of round lenses lie, of the nearest such,
    plainly and as nearness, narrow and wide; how far along that line it is, 1
    at the light and -1 across the middle; how far out that light is; and how
    far the nearest light."""
    width, height = int(line['width']) // 2, int(line['height']) // 2
    y, x = torch.meshgrid((torch.arange(height) + 0.5) / height - 0.5,
                          ((torch.arange(width) + 0.5) / width - 0.5) * width / height, indexing='ij')
    off, along, out, far = [], [], [], []
    for light in line['lights']:
        u, v = (light['x'] - 0.5) * width / height, light['y'] - 0.5
        size = max((u * u + v * v) ** 0.5, 0.02)
        off.append((x * v - y * u).abs() / size)
        along.append((x * u + y * v) / size ** 2)
        out.append(torch.full_like(x, size))
        far.append((x - u).hypot(y - v))
    least, which = torch.stack(off).min(0)
    along, out = (torch.stack(one).gather(0, which[None])[0] for one in (along, out))
    near = [torch.exp(-0.5 * (least / reach) ** 2) for reach in (0.03, 0.12)]
    return torch.stack([least, *near, along.clamp(-3, 3) / 3, out, torch.stack(far).amin(0)])


def moved(flare, far, seed):
    """FLARE, light, under an affine map about the middle, another one for
    each: if FAR any turn, scales of 0.75 to 1.33 a side and a shift up to a
    quarter; else a shift up to half a pixel, which softens as much. What comes
    from beside the picture is its mirror image, without an edge, and all light
    together stays as much, within a factor of 2."""
    random = torch.Generator().manual_seed(seed)
    n, _, height, width = flare.shape

    def even(low, high):
        return torch.rand(n, generator=random) * (high - low) + low
    turn, shear = even(-numpy.pi, numpy.pi), even(-numpy.pi, numpy.pi)
    scale = torch.exp(even(-0.29, 0.29)), torch.exp(even(-0.29, 0.29))
    shift = even(-0.5, 0.5), even(-0.5, 0.5)
    if far:
        def rotation(a):
            return torch.stack([torch.cos(a), -torch.sin(a), torch.sin(a), torch.cos(a)], 1).view(n, 2, 2)
        linear = rotation(turn) @ torch.diag_embed(torch.stack(scale, 1)) @ rotation(shear)
        offset = torch.stack(shift, 1)
    else:
        linear = torch.eye(2).expand(n, 2, 2)
        offset = torch.stack([2 * shift[0] / width, 2 * shift[1] / height], 1)
    flare = flare.float()
    grid = F.affine_grid(torch.cat([linear, offset[:, :, None]], 2), list(flare.shape), align_corners=False)
    result = F.grid_sample(flare, grid, padding_mode='reflection', align_corners=False)
    gain = (flare.mean((1, 2, 3)) / result.mean((1, 2, 3)).clamp(min=1e-6)).clamp(0.5, 2)
    return (result * gain.view(-1, 1, 1, 1)).half()
