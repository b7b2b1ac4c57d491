// SPDX-License-Identifier: MIT
//
// web_bits.js GLINT FOLDER FIRST COUNT WASM... - draws pictures FIRST .. FIRST + COUNT - 1 of
// a fixed sequence by the WebAssembly modules and by the program GLINT with --rays exact, and
// checks that the bytes are equal. Every fourth picture has 16 bits a sample.
import {execFileSync} from "node:child_process";
import fs from "node:fs";
import path from "node:path";
import {init, lampFile} from "../../tools/hosts/web/glint.js";

const [program, folder, first, count, ...modules] = process.argv.slice(2);

// Numbers 0 .. 1 by a hash of the picture's number and their place.
let state = 0;
function draw() {
    state = (Math.imul(state ^ (state >>> 15), 0x2c1b3c6d) + 0x9e3779b9) >>> 0;
    const mixed = Math.imul(state ^ (state >>> 12), 0x297a2d39) >>> 0;
    return ((mixed ^ (mixed >>> 15)) >>> 0) / 2 ** 32;
}
const within = (low, high) => low + draw() * (high - low);
const whole = (low, high) => Math.floor(within(low, high + 1));
const one = list => list[whole(0, list.length - 1)];

// A night picture: a sloping ground, noise, and lamps that clip, with halos. One of five is monochrome but for a code.
function picture(w, h) {
    const rgba = new Uint8Array(4 * w * h).fill(255);
    const base = [within(0, 60), within(0, 60), within(0, 90)], slope = within(-40, 60), noise = within(0, 20);
    const lamps = Array.from({length: whole(0, 3)}, () => ({x: within(0, w), y: within(0, h), r: within(0.7, 6),
        rgb: [within(0.5, 1), within(0.5, 1), within(0.3, 1)], light: within(200, 3000)}));
    for (let y = 0; y < h; y++)
        for (let x = 0; x < w; x++)
            for (let c = 0; c < 3; c++) {
                let v = base[c] + slope * y / h + noise * draw();
                for (const l of lamps) {
                    const d2 = ((x - l.x) ** 2 + (y - l.y) ** 2) / l.r ** 2;
                    v += d2 < 400 ? l.rgb[c] * l.light / (1 + d2) ** 2 : 0;
                }
                rgba[4 * (y * w + x) + c] = Math.max(0, Math.min(255, Math.round(v)));
            }
    if (draw() < 0.2)
        for (let i = 0; i < rgba.length; i += 4)
            rgba.fill(rgba[i + 1], i, i + 3), rgba[i + 2] ^= draw() < 0.5;
    return rgba;
}

// Lenses of spheres; and a zoom and one of aspheres, whose lamps take seconds of processor time each.
const CHEAP = ["heliar-tronnier", "double-gauss-angenieux", "tessar-zeiss-50"], COSTLY = ["nikon-zoom-short", "phone-five"];
function options() {
    // Each lamp, and each of the samples of a wide lamp, takes as much time again.
    const o = {lens: one(draw() < 0.8 ? CHEAP : COSTLY), coating: one(["mixed", "none", "table", "broadband-3"]), "area-samples": one(["1", "2", "3", "7"])};
    if (COSTLY.includes(o.lens))
        Object.assign(o, {"area-samples": "1", "max-lights": "1"});
    if (draw() < 0.4) o.strength = within(0.05, 3).toFixed(3);
    else o.exposure = within(-6, 2).toFixed(2);
    if (draw() < 0.5) o["f-number"] = within(6, 40).toFixed(1);
    if (draw() < 0.5)
        o.stop = one(["circle", `polygon:${whole(3, 16)},${whole(0, 90)}`, `polygon:${whole(5, 9)},round:${within(0, 1).toFixed(2)}`,
            `circle,soft:${within(0, 0.6).toFixed(2)}`]);
    if (draw() < 0.3) o.starburst = one(["off", within(0, 4).toFixed(2)]);
    if (draw() < 0.3) o.veil = within(0, 0.1).toFixed(3);
    if (draw() < 0.2) o.haze = within(0, 0.1).toFixed(3);
    if (draw() < 0.15) o.dust = `${within(0, 0.03).toFixed(4)},${whole(1, 9)}`;
    if (draw() < 0.15) o["front-dust"] = `${within(0, 0.03).toFixed(4)},${whole(1, 9)}`;
    if (draw() < 0.15) o.only = one(["ghosts", "starburst"]);
    if (draw() < 0.1) o.wavelengths = one(["3", "7", "650,532,450"]);
    if (draw() < 0.1) o.balance = "yes";
    if (draw() < 0.15) o.threshold = `${within(-2, 0).toFixed(2)},-2`;
    if (!o["max-lights"] && draw() < 0.1) o["max-lights"] = `${whole(1, 40)}`;
    if (draw() < 0.1) o.tile = one(["8", "16", "32"]);
    if (draw() < 0.1) o.gain = within(0, 3).toFixed(2);
    return o;
}

// Returns a PPM file of the samples RGBA, each as DEEP ? 2 : 1 bytes.
function makePpm(rgba, w, h, deep) {
    const rgb = Buffer.from(rgba.filter((_, i) => i % 4 < 3));
    return Buffer.concat([Buffer.from(`P6\n${w} ${h}\n${deep ? 65535 : 255}\n`), deep ? Buffer.from([...rgb].flatMap(v => [v, v])) : rgb]);
}

// At 16 bits few samples may differ by few codes: sin, cos, atan2 and hypot of two C libraries round differently.
function compare(name, want, got, deep) {
    let differ = want.length === got.length ? 0 : Infinity;
    for (let i = want.length % 2; deep && i < want.length; i += 2) {
        const by = Math.abs(want.readUInt16BE(i) - got.readUInt16BE(i));
        differ += by > 16 ? Infinity : by > 0;
    }
    if (deep ? 500 * differ > want.length / 2 : !want.equals(got))
        throw new Error(`${name}: pictures differ`);
}

const engines = await Promise.all(modules.map(async file => ({name: file, glint: await init(fs.readFileSync(file))})));
const [input, output, csv, txt] = ["in.ppm", "out.ppm", "lamps.csv", "ghosts.txt"].map(name => path.join(folder, name));
let failed = 0;
for (let k = +first; k < +first + +count; k++) {
    state = (k + 1) * 2654435761 >>> 0;
    const w = whole(33, 160), h = whole(25, 120), rgba = picture(w, h), o = options(), deep = k % 4 === 3;
    if (draw() < 0.3)
        o.ghosts = `${whole(0, 7)} mute\n${whole(0, 8)} gain ${within(0, 3).toFixed(2)} tint 1,${within(0, 2).toFixed(2)},0.5\n${draw() < 0.3 ? "8 solo\n" : ""}`;
    const line = ["overlay", input, "-o", output, "-q", "--rays", "exact",
        ...Object.entries(o).flatMap(([key, value]) => value === "yes" ? ["--" + key] : ["--" + key, key === "ghosts" ? txt : value])];
    fs.writeFileSync(input, makePpm(rgba, w, h, deep));
    if (o.ghosts)
        fs.writeFileSync(txt, o.ghosts);
    try {
        for (const {glint} of engines) {
            glint.options(o);
            glint.size(w, h);
        }
        let lamps = null;
        if (draw() < 0.5) { // as the page does with lamps that were moved
            lamps = engines[0].glint.find(rgba).map(lamp => ({...lamp, x: lamp.x + within(-9, 9), power: lamp.power * within(0.2, 5)}));
            lamps.push({x: within(-50, w + 50), y: within(-50, h + 50), power: 2 ** within(8, 16), r: 1, g: within(0.2, 1), b: 0.5,
                size: one([0, within(0, 5)]), shape: 1, turn: 0, level: 1, seen: 0});
            fs.writeFileSync(csv, lampFile(lamps));
            line.push("--lights", csv);
        }
        execFileSync(program, line, {stdio: ["ignore", "ignore", "pipe"]});
        const want = fs.readFileSync(output);
        for (const {name, glint} of engines) {
            glint.find(rgba);
            // Twice, as the page draws with the same engine again and again.
            for (const time of k % 4 ? ["once"] : ["once", "again"]) {
                const got = rgba.slice();
                if (!deep)
                    glint.draw(got, lamps);
                compare(`${name}, ${time}`, want, deep ? Buffer.concat([want.subarray(0, -2 * 3 * w * h), glint.drawDeep(rgba, lamps)]) :
                    makePpm(got, w, h, false), deep);
            }
        }
    } catch (error) {
        failed++;
        console.log(`  picture ${k}: ${error.message.trim()}\n  glint ${line.join(" ")}`);
    }
}
if (failed)
    console.log(`  ${failed} of ${count} differ`);
process.exitCode = failed ? 1 : 0;
