# SPDX-License-Identifier: MIT
#
# remover.py - a small network that takes ghosts out of pictures.
import torch
import torch.nn.functional as F
from torch import nn

BLOCK = 2  # pixels a side that are one place of the network
PLACES = 6  # channels of a pixel's place
SEEN = 0.0024  # light of a flare that counts as one: 8 codes


def block(n_in, n_out):
    layers = []
    for n in (n_in, n_out):
        layers += [nn.Conv2d(n, n_out, 3, padding=1, bias=False), nn.BatchNorm2d(n_out), nn.ReLU(True)]
    return nn.Sequential(*layers)


class Remover(nn.Module):
    """A U-Net over blocks of 2 x 2 pixels, whose coarsest places are 16 pixels
    wide, so that it sees the whole of a picture. It is given the picture and
    where its lights are, both turned by half about the middle, where a light's
    ghosts may be, and the place of a block by the lights and the middle; it says
    the root of the flare's light, as a share of that of the picture."""

    def __init__(self, sizes=(16, 32, 48, 64)):
        super().__init__()
        self.first = nn.Conv2d(BLOCK ** 2 * 4 + 5 + PLACES, sizes[0], 1)
        self.down = nn.ModuleList(block(i, o) for i, o in zip(sizes[:1] + sizes, sizes))
        self.up = nn.ModuleList(block(i + o, o) for i, o in zip(sizes[:0:-1], sizes[-2::-1]))
        self.last = nn.Conv2d(2 * sizes[0], BLOCK ** 2 * 3, 1)
        self.to(memory_format=torch.channels_last)
        nn.init.constant_(self.last.bias, -2)  # little flare at first
        nn.init.normal_(self.last.weight, std=0.05)

    def forward(self, light, mask, place):
        n, _, height, width = light.shape
        v, u = torch.meshgrid(torch.linspace(-1, 1, height), torch.linspace(-1, 1, width), indexing='ij')
        out = (u * u + v * v).sqrt().expand(n, 1, height, width)
        seen = torch.cat([light.sqrt(), mask], 1)
        coarse = F.avg_pool2d(torch.cat([seen.flip((2, 3)), place, out], 1), BLOCK)
        x = torch.cat([F.pixel_unshuffle(seen, BLOCK), coarse], 1)
        first = x = F.relu(self.first(x.contiguous(memory_format=torch.channels_last)))
        kept = []
        for i, down in enumerate(self.down):
            x = down(F.max_pool2d(x, 2) if i else x)
            kept.append(x)
        for up, side in zip(self.up, kept[-2::-1]):
            x = up(torch.cat([F.interpolate(x, scale_factor=2.0), side], 1))
        share = torch.sigmoid(self.last(torch.cat([x, first], 1)).float())
        return F.pixel_shuffle(share, BLOCK) * light.sqrt()


def without(light, root):
    """Light less that of a flare of ROOT."""
    return (light - root ** 2).clamp(min=0)


def tone(light):
    """Its root, but for a slope that ends where noise begins."""
    return (light + 0.001).sqrt()


def loss_of(root, light, truth, flare, mask):
    """What the pictures and the flares are off by, in roots of light, as a share of
    what they are off by if they are left, so that a broad bright flare counts no
    more than a small one; four times as much where there is a flare. Lights
    themselves are left out."""
    weight = (1 - mask) * (1 + 3 * (flare.amax(1, keepdim=True) > SEEN).float())

    def off(root):
        error = (tone(without(light, root)) - tone(truth)) ** 2 + 0.25 * (root - flare.sqrt()) ** 2
        return (weight * error).mean((1, 2, 3))
    return ((off(root) + 1e-6) / (off(torch.zeros_like(root)) + 1e-4)).sqrt().mean()
