"""Writes raster_shapes.txt and raster_scales.txt: what pygame-ce 2.5.8, Pillow 13.0 and OpenCV 5.0 draw and scale.

Run it in this folder, in an environment with these packages. Each line is a case and the CRC-32 of its pixels.
"""
import random
import zlib

import cv2
import numpy as np
import pygame
from PIL import Image

SIDE, COLOUR = 120, (200, 100, 50)
random.seed(5)


def drawn(draw):
    surface = pygame.Surface((SIDE, SIDE))
    draw(surface)
    return zlib.crc32(pygame.image.tobytes(surface, "RGB"))


with open("raster_shapes.txt", "w") as out:
    places = [(60, 60, r) for r in range(1, 41)]
    places += [(random.randrange(-20, 140), random.randrange(-20, 140), random.randrange(1, 41)) for _ in range(20)]
    for x, y, r in places:
        print("disc", x, y, r, drawn(lambda s: pygame.draw.circle(s, COLOUR, (x, y), r)), file=out)
    for case in range(160):
        low, high = random.choice([(0, 4), (0, 10), (-10, 30), (0, 118), (-20, 140)])
        corners = [(random.randrange(low, high), random.randrange(low, high)) for _ in range(3 + case % 8)]
        flat = [number for corner in corners for number in corner]
        print("polygon", *flat, drawn(lambda s: pygame.draw.polygon(s, COLOUR, corners, 0)), file=out)


def native(width, height):
    """Noise; raster_scale.rs makes the same."""
    value = np.arange(3 * width * height, dtype=np.uint64) * np.uint64(2654435761) + np.uint64(31 * width + height)
    value ^= value >> np.uint64(13)
    value = value * np.uint64(0x9E3779B1) & np.uint64(0xFFFFFFFFFFFF)
    value ^= value >> np.uint64(17)
    return (value & np.uint64(255)).astype(np.uint8).reshape(height, width, 3)


def pillow(picture, size):
    # Pillow 13 begins with columns where that is quicker; before, it never did.
    for step in (size[0], picture.shape[0]), size:
        picture = np.asarray(Image.fromarray(picture).resize(step, Image.BILINEAR))
    return picture


FILTERS = {
    "pillow": pillow,
    "area": lambda picture, size: cv2.resize(picture, size, interpolation=cv2.INTER_AREA),
    "linear": lambda picture, size: cv2.resize(picture, size, interpolation=cv2.INTER_LINEAR),
}
sizes = [(side, side, 84, 84) for side in (40, 48, 56, 64, 80, 84, 104, 128, 152, 160, 168, 252, 256, 500)]
sizes += [(160, 210, 84, 84), (49, 49, 1, 1), (98, 98, 2, 2), (1, 1, 84, 84), (2000, 5, 84, 84), (5, 2000, 84, 84)]
while len(sizes) < 80:
    width, height = random.randrange(1, 120), random.randrange(1, 120)
    kind = len(sizes) % 4
    if kind == 0:
        sizes.append((width * random.randrange(1, 5), height * random.randrange(1, 5), width, height))
    elif kind == 1:
        sizes.append((width, width, height, height))
    else:
        sizes.append((random.randrange(1, 250), random.randrange(1, 250), width, height))
with open("raster_scales.txt", "w") as out:
    for case in sizes:
        picture, size = native(*case[:2]), case[2:]
        grey = cv2.cvtColor(picture, cv2.COLOR_RGB2GRAY)
        for name, scaled in FILTERS.items():
            colour = scaled(picture, size)
            mean = (colour.astype(int).sum(2) // 3).astype(np.uint8)
            pictures = colour, scaled(grey, size), mean
            print(*case, name, *(zlib.crc32(np.ascontiguousarray(p).tobytes()) for p in pictures), file=out)
