// SPDX-License-Identifier: MIT
//
// web_bits.js GLINT WASM FOLDER FIRST COUNT - draws pictures FIRST .. FIRST + COUNT - 1 of
// a fixed sequence by the WebAssembly module and by the program GLINT with --rays exact, and
// checks that the bytes are equal.
import {execFileSync} from "node:child_process";
import fs from "node:fs";
import path from "node:path";
import {ghostFile, init, lampFile} from "../../tools/hosts/web/glint.js";

const [program, wasm, folder, first, count] = process.argv.slice(2);

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

// A night picture: a sloping ground, noise, and lamps that clip, with halos.
function picture(w, h) {
    const rgba = new Uint8Array(4 * w * h).fill(255);
    const base = [within(0, 60), within(0, 60), within(0, 90)], slope = within(-40, 60), noise = within(0, 20);
    const lamps = Array.from({length: whole(0, 5)}, () => ({x: within(0, w), y: within(0, h), r: within(0.7, 6),
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
    return rgba;
}

// Lenses of seconds: of spheres, zooms, of aspheres.
const LENSES = ["heliar-tronnier", "double-gauss-angenieux", "nikon-zoom-short", "tessar-zeiss-50", "phone-five"];
function options() {
    const o = {lens: one(LENSES), coating: one(["mixed", "none", "table", "broadband-3"])};
    if (draw() < 0.7) o.strength = within(0.05, 3).toFixed(3);
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
    if (draw() < 0.1) o["max-lights"] = `${whole(1, 40)}`;
    if (draw() < 0.1) o.tile = one(["8", "16", "32"]);
    if (draw() < 0.1) o.gain = within(0, 3).toFixed(2);
    return o;
}

function compare(name, want, got) {
    const n = want.length;
    let differ = n === got.length / 4 * 3 ? 0 : n;
    for (let i = 0, j = 0; i < n && !differ; i++, j += i % 3 ? 1 : 2)
        differ += want[i] !== got[j];
    if (differ)
        throw new Error(`${name}: pictures differ`);
}

const glint = await init(fs.readFileSync(wasm));
let failed = 0;
for (let k = +first; k < +first + +count; k++) {
    state = (k + 1) * 2654435761 >>> 0;
    const w = whole(33, 320), h = whole(25, 200), rgba = picture(w, h), o = options();
    const lists = draw() < 0.5, head = `P6\n${w} ${h}\n255\n`;
    const file = path.join(folder, "in.ppm"), out = path.join(folder, "out.ppm"), csv = path.join(folder, "lamps.csv"), txt = path.join(folder, "ghosts.txt");
    const muted = draw() < 0.2 ? [whole(0, 9), whole(0, 9)] : [];
    fs.writeFileSync(file, Buffer.concat([Buffer.from(head), Buffer.from(rgba.filter((_, i) => i % 4 < 3))]));
    const line = ["overlay", file, "-o", out, "-q", "--rays", "exact",
        ...Object.entries(o).flatMap(([key, value]) => value === "yes" ? ["--" + key] : ["--" + key, value])];
    if (muted.length) {
        fs.writeFileSync(txt, ghostFile(muted));
        line.push("--ghosts", txt);
    }
    try {
        glint.options(o, muted);
        glint.size(w, h);
        let lamps = glint.find(rgba);
        if (lists) { // as the page does with lamps that were moved
            lamps = lamps.map(lamp => ({...lamp, x: lamp.x + within(-9, 9), power: lamp.power * within(0.2, 5)}));
            lamps.push({x: within(-50, w + 50), y: within(-50, h + 50), power: 2 ** within(8, 16), r: 1, g: within(0.2, 1), b: 0.5,
                size: one([0, within(0, 5)]), shape: 1, turn: 0, level: 1, seen: 0});
            fs.writeFileSync(csv, lampFile(lamps));
            line.push("--lights", csv);
        }
        execFileSync(program, line, {stdio: ["ignore", "ignore", "pipe"]});
        const got = rgba.slice();
        glint.draw(got, lists ? lamps : null);
        compare("once", fs.readFileSync(out).subarray(head.length), got);
        const again = rgba.slice(); // the page draws with the same engine again and again
        glint.draw(again, lists ? lamps : null);
        compare("again", fs.readFileSync(out).subarray(head.length), again);
    } catch (error) {
        failed++;
        console.log(`  picture ${k}: ${error.message.trim()}\n  glint ${line.join(" ")}`);
    }
}
if (failed)
    console.log(`  ${failed} of ${count} differ`);
process.exitCode = failed ? 1 : 0;
