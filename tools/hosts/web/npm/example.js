// SPDX-License-Identifier: MIT
//
// example.js IN.ppm OUT.ppm [LENS [F-NUMBER]] - adds the flare of the lamps in a picture, and prints the lamps. The
// result equals that of glint overlay --rays exact.
import fs from "node:fs";
import {init} from "glint-flare";

const [input, output, lens = "heliar-tronnier", fNumber] = process.argv.slice(2);
const file = fs.readFileSync(input);
const head = /^P6\s+(\d+)\s+(\d+)\s+255\s/.exec(file.toString("latin1", 0, 64));
const [width, height] = head ? [Number(head[1]), Number(head[2])] : [0, 0];
const rgb = file.subarray(head?.[0].length);
if (!head || rgb.length !== 3 * width * height)
    throw new Error(input + ": not a binary PPM of 8 bits a sample");

const engine = await init();
engine.options({lens, ...fNumber ? {"f-number": Number(fNumber)} : {}});
engine.size(width, height);

let pixels = engine.pixels.fill(255);
for (let i = 0; i < width * height; i++)
    pixels.set(rgb.subarray(3 * i, 3 * i + 3), 4 * i);
const lamps = engine.find(engine.pixels);
engine.draw(engine.pixels);
for (const {x, y, power} of lamps)
    console.log(`lamp at ${x.toFixed(1)}, ${y.toFixed(1)}: light of ${power.toFixed(0)} white pixels`);

pixels = engine.pixels; // read again after draw()
for (let i = 0; i < width * height; i++)
    rgb.set(pixels.subarray(4 * i, 4 * i + 3), 3 * i);
fs.writeFileSync(output, file);
