# SPDX-License-Identifier: MIT
#
# remover.py - a small network that takes ghosts out of pictures.
import torch
import torch.nn.functional as F
from torch import nn
BLOCK = 4  # pixels a side that are one place of the network
SEEN = 0.0024  # light of a flare that counts as one: 8 codes


def block(n_in, n_out):
    return nn.Sequential(nn.Conv2d(n_in, n_out, 3, padding=1), nn.ReLU(True),
                         nn.Conv2d(n_out, n_out, 3, padding=1), nn.ReLU(True))


class Remover(nn.Module):
    """A U-Net over blocks of 4 x 4 pixels. It sees the picture, the picture
    mirrored at its middle, where a ghost's light is, where the lights are, and
    the place of a pixel by them and by the middle; it says the root of the
    flare's light."""

    def __init__(self, width=20):
        super().__init__()
        sizes = [width, int(1.5 * width), 2 * width]
        self.first = nn.Conv2d(BLOCK ** 2 * 12, width, 1)
        self.down = nn.ModuleList(block(i, o) for i, o in zip([width] + sizes, sizes))
        self.up = nn.ModuleList(block(i + o, o) for i, o in zip(sizes[:0:-1], sizes[-2::-1]))
        self.last = nn.Conv2d(2 * width, BLOCK ** 2 * 3, 1)
        self.to(memory_format=torch.channels_last)
        nn.init.constant_(self.last.bias, -2)  # little flare at first

    def forward(self, light, mask, spokes):
        n, _, height, width = light.shape
        v, u = torch.meshgrid(torch.linspace(-1, 1, height), torch.linspace(-1, 1, width), indexing='ij')
        place = (u * u + v * v).sqrt().expand(n, 1, height, width)
        root = light.sqrt()
        mirrored = torch.cat([root, mask], 1).flip((2, 3))
        x = F.pixel_unshuffle(torch.cat([root, mask, mirrored, spokes, place], 1), BLOCK)
        first = x = F.relu(self.first(x.contiguous(memory_format=torch.channels_last)))
        kept = []
        for i, down in enumerate(self.down):
            x = down(F.max_pool2d(x, 2) if i else x)
            kept.append(x)
        for up, side in zip(self.up, kept[-2::-1]):
            x = up(torch.cat([F.interpolate(x, scale_factor=2.0), side], 1))
        return F.pixel_shuffle(torch.sigmoid(self.last(torch.cat([x, first], 1))), BLOCK)


def without(light, root):
    """Light less that of a flare of ROOT."""
    return (light - root ** 2).clamp(min=0)


def tone(light):
    """Its root, but for a slope that ends where noise begins."""
    return (light + 0.001).sqrt()


def loss_of(root, light, truth, flare, mask):
    """Mean of what the picture and the flare are off by, in roots of light, four
    times as much where there is a flare. Lights themselves are left out."""
    weight = (1 - mask) * (1 + 3 * (flare.amax(1, keepdim=True) > SEEN).float())
    off = (tone(without(light, root)) - tone(truth)).abs() + 0.5 * (root - flare.sqrt()).abs()
    return (weight * off).mean()
