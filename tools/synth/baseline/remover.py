# SPDX-License-Identifier: MIT
#
# remover.py - a small network that takes ghosts out of pictures.
import torch
import torch.nn.functional as F
from torch import nn

from pairs import decode, encode

BLOCK = 4  # pixels a side that are one place of the network


def block(n_in, n_out):
    return nn.Sequential(nn.Conv2d(n_in, n_out, 3, padding=1), nn.ReLU(True),
                         nn.Conv2d(n_out, n_out, 3, padding=1), nn.ReLU(True))


class Remover(nn.Module):
    """A U-Net over blocks of 4 x 4 pixels. It sees the picture, the picture
    mirrored at its middle, where a ghost's light is, where the lights are, and
    the place of a pixel by them and by the middle; it says the flare's codes."""

    def __init__(self, width=24):
        super().__init__()
        sizes = [width, int(1.5 * width), 2 * width]
        self.first = nn.Conv2d(BLOCK ** 2 * 12, width, 1)
        self.down = nn.ModuleList(block(i, o) for i, o in zip([width] + sizes, sizes))
        self.up = nn.ModuleList(block(i + o, o) for i, o in zip(sizes[:0:-1], sizes[-2::-1]))
        self.last = nn.Conv2d(2 * width, BLOCK ** 2 * 3, 1)
        self.to(memory_format=torch.channels_last)
        nn.init.constant_(self.last.bias, -2)  # little flare at first

    def forward(self, codes, mask, spokes):
        n, _, height, width = codes.shape
        v, u = torch.meshgrid(torch.linspace(-1, 1, height), torch.linspace(-1, 1, width), indexing='ij')
        place = (u * u + v * v).sqrt().expand(n, 1, height, width)
        mirrored = torch.cat([codes, mask], 1).flip((2, 3))
        x = F.pixel_unshuffle(torch.cat([codes, mask, mirrored, spokes, place], 1), BLOCK)
        first = x = F.relu(self.first(x.contiguous(memory_format=torch.channels_last)))
        kept = []
        for i, down in enumerate(self.down):
            x = down(F.max_pool2d(x, 2) if i else x)
            kept.append(x)
        for up, side in zip(self.up, kept[-2::-1]):
            x = up(torch.cat([F.interpolate(x, scale_factor=2.0), side], 1))
        return F.pixel_shuffle(torch.sigmoid(self.last(torch.cat([x, first], 1))), BLOCK)


def without(codes, flare):
    """Codes of the picture whose light is less by that of FLARE."""
    return encode((decode(codes) - decode(flare)).clamp(1e-6, 1))


def loss_of(guess, codes, truth, flare, mask):
    """Mean of what the picture and the flare are off by, in codes, four times
    as much where there is a flare. Lights themselves are left out."""
    weight = (1 - mask) * (1 + 3 * (flare.amax(1, keepdim=True) > 8 / 255).float())
    off = (without(codes, guess) - truth).abs() + 0.5 * (guess - flare).abs()
    return (weight * off).mean()
