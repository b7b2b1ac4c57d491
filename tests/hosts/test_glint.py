# SPDX-License-Identifier: MIT
"""Checks that the Python package gives the same bytes as the command. Run by tests/hosts/python, from the root."""
import inspect
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import threading
import unittest

import glint
import numpy as np

sys.path.insert(0, "tools/hosts/python/examples")
from ppm import read, write  # noqa: E402

GLINT = os.environ["GLINT"]
PHOTO = "tests/data/bridge.ppm"
LENS = "heliar-tronnier"


def command(*words):
    return subprocess.run([GLINT, *words, "-q"], check=True, stdout=subprocess.PIPE).stdout


class Package(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.photo = read(PHOTO)

    def path(self, name):
        return str(pathlib.Path(self.folder.name) / name)

    def by_command(self, *options):
        command("overlay", PHOTO, "-o", self.path("want.ppm"), "--rays", "model", *options)
        return read(self.path("want.ppm"))

    def test_overlay_is_overlays(self):
        for options, words in [
            ({}, ["--lens", "nikon-zoom-short"]),
            ({"lens": LENS, "strength": 0.75, "quality": 0.25}, ["--lens", LENS, "--strength", ".75", "--quality", ".25"]),
            ({"lens": LENS, "f_number": 11, "gain": 2}, ["--lens", LENS, "--f-number", "11", "--gain", "2"]),
            ({"lens": LENS, "stop": (6, 0), "starburst": 2}, ["--lens", LENS, "--stop", "polygon:6", "--starburst", "2"]),
            ({"lens": LENS, "exposure": 1, "threads": 1}, ["--lens", LENS, "--exposure", "1"]),
            ({"lens": LENS, "exposure": -6, "lights_at": [(100, 50), (20, 9, 15)]},
             ["--lens", LENS, "--exposure", "-6", "--lights", "none", "--light-at", "100,50", "--light-at", "20,9,15"]),
            ({"lens": LENS, "lights_at": [(100, 50)]}, ["--lens", LENS, "--lights", "none", "--light-at", "100,50"]),
            ({"lens": LENS, "strength": 0.8, "veil": 0.02, "lights_at": [(300, 200, 6), (20, 9, 15), (-30, 100)]},
             ["--lens", LENS, "--strength", ".8", "--veil", ".02", "--lights", "none", "--light-at", "300,200,6", "--light-at", "20,9,15",
              "--light-at=-30,100"]),
            ({"lens": LENS, "quality": "draft", "stop": "polygon:7,20,round:.3,soft:.2", "headroom": 3, "haze": 0.01},
             ["--lens", LENS, "--quality", "draft", "--stop", "polygon:7,20,round:.3,soft:.2", "--headroom", "3",
              "--haze", ".01"]),
            ({"lens": LENS, "threshold": "-0.5,-0.6", "whole": 0, "cull": 1, "half": True, "sensor": "24x16"},
             ["--lens", LENS, "--threshold=-0.5,-0.6", "--whole", "0", "--cull", "1", "--half", "--sensor", "24x16"]),
            ({"lens": LENS, "dust": "0.02,3", "front_dust": "0.01", "wavelengths": "600,500", "balance": True},
             ["--lens", LENS, "--dust", ".02,3", "--front-dust", ".01", "--wavelengths", "600,500", "--balance"]),
        ]:
            with self.subTest(options=options):
                got = self.photo.copy()
                report = glint.overlay(got, **options)
                self.assertGreater(report.ghosts, 0)
                self.assertTrue((got != self.photo).any())
                np.testing.assert_array_equal(got, self.by_command(*words))

    def test_places(self):
        want, lights = self.photo.copy(), [(100, 50)]
        glint.overlay(want, LENS, lights_at=lights)
        padded = np.zeros((256, 500, 3), np.uint8)
        padded[:, :384] = self.photo
        glint.overlay(padded[:, :384], LENS, lights_at=lights)
        np.testing.assert_array_equal(padded[:, :384], want)
        self.assertFalse(padded[:, 384:].any())
        turned = np.ascontiguousarray(self.photo[::-1])
        glint.overlay(turned[::-1], LENS, lights_at=lights)
        np.testing.assert_array_equal(turned[::-1], want)
        bgr = np.ascontiguousarray(self.photo[..., ::-1])
        glint.overlay(bgr, LENS, lights_at=lights, order="BGR")
        np.testing.assert_array_equal(bgr[..., ::-1], want)
        bgra = np.dstack([self.photo[..., ::-1], np.full((256, 384), 77, np.uint8)])
        glint.overlay(bgra, LENS, lights_at=lights, order="BGR")
        np.testing.assert_array_equal(bgra[..., 2::-1], want)
        self.assertTrue((bgra[..., 3] == 77).all())

    def test_lenses_are_the_commands(self):
        listed = subprocess.run([GLINT, "lenses", "--json"], check=True, stdout=subprocess.PIPE, text=True).stdout
        self.assertEqual(glint.lenses(), sorted(lens["name"] for lens in json.loads(listed)["lenses"]))

    def test_bake_is_bakes(self):
        command("bake", LENS, "-o", self.path("x.glint"))
        model = glint.bake(LENS)
        # bytes 8 to 15 are size and checksum; the command adds a note of 220 bytes
        self.assertEqual(model[16:], pathlib.Path(self.path("x.glint")).read_bytes()[16:-220])
        by_bytes, by_file = self.photo.copy(), self.photo.copy()
        glint.overlay(by_bytes, model)
        glint.overlay(by_file, self.path("x.glint"))
        np.testing.assert_array_equal(by_bytes, by_file)
        np.testing.assert_array_equal(by_bytes, self.by_command("--lens", self.path("x.glint")))

    def test_render_is_physical(self):
        lamp = glint.Lamp(8, 33, 3e5)
        light = glint.render(LENS, (135, 240), [lamp])
        self.assertEqual((light.shape, light.dtype), ((135, 240, 3), np.float32))
        twice = glint.render(LENS, (135, 240), [glint.Lamp(8, 33, 6e5)])
        self.assertAlmostEqual(float(twice.sum() / light.sum()), 2, delta=0.02)
        ghosts = glint.render(LENS, (135, 240), [lamp], starburst=0, stop=(0, 0))
        command("render", LENS, "-o", self.path("x.pfm"), "--size", "240x135", "--light", "8,33,3e5", "--stop", "circle",
                "--only", "ghosts", "--wavelengths", "auto")
        data = pathlib.Path(self.path("x.pfm")).read_bytes()
        want = np.frombuffer(data[-240 * 135 * 12:], "<f4").reshape(135, 240, 3)[::-1]
        self.assertLess(np.abs(ghosts - want).mean() / want.mean(), 0.02)

    def test_video_is_followed(self):
        engine, frames = glint.Engine(LENS, 256, 384), []
        for i in range(3):
            frame = self.photo.copy()
            engine.overlay(frame, elapsed=0.04)
            frames.append(frame)
            write(self.path(f"in-{i}.ppm"), self.photo)
        command("overlay", self.path("in-%d.ppm"), "-o", self.path("out-%d.ppm"), "--lens", LENS)
        for i, frame in enumerate(frames):
            np.testing.assert_array_equal(frame, read(self.path(f"out-{i}.ppm")))
        self.assertTrue((frames[0] != self.photo).any())

    def test_video_of_given_lamps(self):
        engine, path = glint.Engine(LENS, 256, 384), self.path("lights.csv")
        places = [(100 + 10 * i, 50) for i in range(4)]
        pathlib.Path(path).write_text("".join(f"{i},{x},{y},{65536 >> i}\n" for i, (x, y) in enumerate(places)))
        frames = [self.photo.copy() for _ in places]
        for i, frame in enumerate(frames):
            engine.overlay(frame, [engine.lamp_at(*places[i], 16 - i)], elapsed=0.04)
            write(self.path(f"in-{i}.ppm"), self.photo)
        command("overlay", self.path("in-%d.ppm"), "-o", self.path("out-%d.ppm"), "--lens", LENS, "--lights", path)
        for i, frame in enumerate(frames):
            np.testing.assert_array_equal(frame, read(self.path(f"out-{i}.ppm")))
            self.assertTrue((frame != self.photo).any())

    def test_threads(self):
        want, got = self.photo.copy(), [self.photo.copy() for _ in range(8)]
        glint.overlay(want, LENS)
        threads = [threading.Thread(target=glint.overlay, args=(array, LENS)) for array in got]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for array in got:
            np.testing.assert_array_equal(array, want)

    def test_lamp_at(self):
        engine = glint.Engine(LENS, 256, 384)
        self.assertAlmostEqual(engine.place_of(engine.lamp_at(100, 50))[0], 100, places=6)
        self.assertAlmostEqual(engine.place_of(engine.lamp_at(100, 50))[1], 50, places=6)

    def test_refused(self):
        picture = self.photo
        for text, call in [
            ("no lens 'x'; there are .*canon", lambda: glint.overlay(picture, "x")),
            ("not a model", lambda: glint.overlay(picture, b"GLINT")),
            ("takes uint8", lambda: glint.overlay(picture.astype(np.float32), LENS)),
            ("takes uint8", lambda: glint.overlay(np.zeros((8, 8, 4), np.uint8), LENS)),
            ("takes a picture", lambda: glint.overlay(np.zeros(8, np.uint8), LENS)),
            ("side by side", lambda: glint.overlay(picture[:, ::2], LENS)),
            ("384x256", lambda: glint.Engine(LENS, 9, 9).overlay(picture)),
            ("quality is 0 to 1", lambda: glint.overlay(picture, LENS, quality=2)),
            ("stop is circle or polygon", lambda: glint.overlay(picture, LENS, stop="round")),
            ("exact rays need the command", lambda: glint.overlay(picture, LENS, quality="exact")),
            ("f-number|f/", lambda: glint.overlay(picture, LENS, f_number=0.1)),
            ("at most", lambda: glint.overlay(picture, LENS, [glint.Lamp(1, 1)] * 2000)),
        ]:
            with self.subTest(text=text), self.assertRaisesRegex(ValueError, text):
                call()
        picture.setflags(write=False)
        with self.assertRaisesRegex(ValueError, "read-only"):
            glint.overlay(picture, LENS)

    def test_options_set_by_name(self):
        made, turned = self.photo.copy(), self.photo.copy()
        glint.Engine(LENS, 256, 384, f_number=16, exposure=2, gain=2).overlay(made)
        engine = glint.Engine(LENS, 256, 384)
        engine.set(f_number=16, exposure=2, gain=2)
        engine.overlay(turned)
        self.assertTrue((made == turned).all())
        for text, options in [("only when the engine is created", {"veil": 0.1}), ("no option", {"strenght": 1}), ("gain accepts: a factor, from 0", {"gain": -1})]:
            with self.subTest(text=text), self.assertRaisesRegex(ValueError, text):
                engine.set(**options)

    def test_keywords_are_the_options(self):
        with self.assertRaisesRegex(TypeError, "keyword argument strenght"):
            glint.overlay(self.photo, LENS, strenght=1)
        listed = {line.split()[0].rstrip("=") for line in command("overlay", "--options").decode().splitlines()}
        for function in glint.Engine, glint.overlay, glint.render:
            keywords = inspect.signature(function).parameters
            self.assertEqual(keywords["strength"].default, 0.5)
            self.assertLessEqual({"--" + name.replace("_", "-") for name in glint.Options.__annotations__}, listed)
            self.assertLessEqual(glint.Options.__annotations__.keys(), keywords.keys())

    def test_examples(self):
        run = lambda *words: subprocess.run([sys.executable, *words], check=True, stdout=subprocess.PIPE, text=True).stdout
        examples = "tools/hosts/python/examples/"
        self.assertIn("ghosts drawn", run(examples + "photograph.py", PHOTO, self.path("a.ppm")))
        np.testing.assert_array_equal(read(self.path("a.ppm")), self.by_command("--lens", LENS))
        self.assertIn("25 degrees", run(examples + "sweep.py", self.path("b.ppm")))
        first = run(examples + "pairs.py", PHOTO, self.path("pairs"), "2")
        self.assertEqual(first, run(examples + "pairs.py", PHOTO, self.path("pairs"), "2"))
        self.assertEqual(len(list(pathlib.Path(self.path("pairs")).iterdir())), 4)


if __name__ == "__main__":
    unittest.main()
