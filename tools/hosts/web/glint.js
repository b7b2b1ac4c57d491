// SPDX-License-Identifier: MIT
//
// glint.js - draws flares by the WebAssembly module, in browsers and in Node. npm/types.js declares the types.
//
//     import {init} from "glint-flare";
//
//     const engine = await init();
//     engine.options({lens: "heliar-tronnier", strength: 0.7});
//     engine.size(width, height);
//     engine.pixels.set(rgba);
//     const lamps = engine.find(engine.pixels);
//     engine.draw(engine.pixels);        or engine.draw(engine.pixels, lamps)
//
// Failures throw an Error with the text that the command would print.

// A lamp: the columns of glint overlay --lights, and their defaults.
export const LAMP = {x: 0, y: 0, power: 65536, r: 1, g: 1, b: 1, size: 0, shape: 1, turn: 0, level: 1, seen: 0};
export const COLUMNS = Object.keys(LAMP);
const MAX_LAMPS = 1024;
const ENOSYS = 52;
const FOUND = -1;

async function load(url) {
    if (url.protocol === "file:")
        return (await import("node:fs/promises")).readFile(url);
    const answer = await fetch(url);
    if (!answer.ok)
        throw new Error(`${url}: ${answer.status} ${answer.statusText}`);
    return answer.arrayBuffer();
}

// Returns an engine with a memory of its own. WASM: the bytes of glint.wasm, or its WebAssembly.Module; by default
// the bytes of the file beside this one.
export async function init(wasm) {
    wasm ??= await load(new URL("glint.wasm", import.meta.url));
    const module = wasm instanceof WebAssembly.Module ? wasm : await WebAssembly.compile(wasm);
    // The module uses no files; its C library refers to these.
    const files = Object.fromEntries(["fd_close", "fd_read", "fd_seek", "fd_write", "poll_oneoff"].map(name => [name, () => ENOSYS]));
    const instance = await WebAssembly.instantiate(module, {wasi_snapshot_preview1: files});
    instance.exports._initialize();
    return new Engine(instance.exports);
}

export class Engine {
    constructor(exports) {
        this.c = exports;
        this.at = 0; // of the pixels, in the module's memory
        this.room = 0;
        this.length = 0;
        this.c.web_reset();
    }

    bytes(at, length) {
        return new Uint8Array(this.c.memory.buffer, at, length);
    }

    text(at) {
        if (!at)
            return "";
        const memory = new Uint8Array(this.c.memory.buffer);
        return new TextDecoder().decode(memory.subarray(at, memory.indexOf(0, at)));
    }

    // Copies BYTES into the module's memory; returns where.
    take(bytes) {
        const at = this.c.web_take(bytes.length || 1);
        if (!at)
            throw new Error("no memory");
        this.bytes(at, bytes.length).set(bytes);
        return at;
    }

    check(value) {
        if (!value)
            throw new Error(this.text(this.c.web_error()) || "failed");
        return value;
    }

    // The table of options, the styles and the lenses.
    tables() {
        const read = at => JSON.parse(this.text(at));
        return {options: read(this.c.web_options()), styles: read(this.c.web_styles()), lenses: read(this.c.web_lenses())};
    }

    set(name, value) {
        const encode = text => this.take(new TextEncoder().encode(text + "\0"));
        const a = encode(name), b = encode(String(typeof value === "boolean" ? Number(value) : value));
        try {
            this.check(this.c.web_set(a, b));
        } finally {
            this.c.web_free(a);
            this.c.web_free(b);
        }
    }

    // Sets all options: those of VALUES, and the defaults of others. The option ghosts is the text of its file.
    options(values) {
        this.c.web_reset();
        for (const [name, value] of Object.entries(values))
            this.set(name, value);
    }

    // Opens the lens of the options, for pictures of this size.
    size(width, height) {
        this.length = 0;
        if (![width, height].every(Number.isInteger))
            throw new Error(`width and height must be integers, not ${width} and ${height}`);
        this.check(this.c.web_size(width, height));
        const length = 4 * width * height;
        if (length > this.room) {
            this.c.web_free(this.at);
            this.at = this.c.web_take(length);
            this.room = this.at ? length : 0;
        }
        if (!this.at)
            throw new Error("no memory for a picture of this size");
        this.length = length;
    }

    // The picture in the module's memory, in the layout of ImageData. find() and draw() copy other arrays to it and back,
    // but not this one. Memory that grows detaches the array, so read it again after each call.
    get pixels() {
        return new Uint8ClampedArray(this.c.memory.buffer, this.at, this.length);
    }

    // Runs WORK on RGBA in the module's memory; copies it back if WORK draws.
    with(rgba, draws, work) {
        if (rgba.length !== this.length)
            throw new Error(`the picture has ${rgba.length} bytes, not the ${this.length} of size(width, height)`);
        const copies = rgba.buffer !== this.c.memory.buffer;
        if (copies)
            this.pixels.set(rgba);
        const value = work(this.at);
        if (draws && copies)
            rgba.set(this.pixels);
        return value;
    }

    rows(n) {
        return new Float64Array(this.c.memory.buffer, this.c.web_lamps(), n * COLUMNS.length);
    }

    // Returns the lamps of RGBA, the strongest first.
    find(rgba) {
        const n = this.with(rgba, false, at => this.c.web_find(at));
        const rows = this.rows(n);
        const lamps = [];
        for (let i = 0; i < n; i++)
            lamps.push(Object.fromEntries(COLUMNS.map((name, k) => [name, rows[i * COLUMNS.length + k]])));
        return lamps;
    }

    // Returns the positions of up to three regions that find() did not accept as lamps, the brightest first.
    doubtful() {
        const at = this.c.web_take(16), list = [];
        while (list.length < 3 && this.c.web_doubtful(list.length, at))
            list.push([...new Float64Array(this.c.memory.buffer, at, 2)]);
        this.c.web_free(at);
        return list;
    }

    setLamps(lamps) {
        if (lamps && lamps.length <= MAX_LAMPS)
            this.rows(lamps.length).set(lamps.flatMap(lamp => COLUMNS.map(name => lamp[name] ?? LAMP[name])));
    }

    // Draws the flare of LAMPS, or of those that find() found, into RGBA.
    draw(rgba, lamps = null) {
        this.setLamps(lamps);
        this.with(rgba, true, at => this.check(this.c.web_draw(at, lamps ? lamps.length : FOUND)));
    }

    // Returns the samples of draw() with 16 bits, high byte first: R G B of the picture, or, if ALONE, R G B A of the flare
    // without the picture.
    drawDeep(rgba, lamps = null, alone = false) {
        const length = this.length / 4 * (alone ? 8 : 6), samples = this.c.web_take(length);
        if (!samples)
            throw new Error("no memory for 16 bits");
        try {
            this.setLamps(lamps);
            this.with(rgba, false, at => this.check(this.c.web_draw_deep(at, lamps ? lamps.length : FOUND, alone, samples)));
            return this.bytes(samples, length).slice();
        } finally {
            this.c.web_free(samples);
        }
    }

    // Returns up to MAX ghosts of the last picture, the brightest first.
    ghosts(max) {
        const at = this.c.web_take(48 * max), n = this.c.web_ghosts(at, max);
        const rows = new Float64Array(this.c.memory.buffer, at, 6 * Math.max(0, n)), list = [];
        for (let i = 0; i < n; i++) {
            const [number, share, x0, y0, x1, y1] = rows.subarray(6 * i);
            list.push({number, share, x0, y0, x1, y1});
        }
        this.c.web_free(at);
        this.check(n >= 0);
        return list;
    }
}

// The rows of LAMPS as a file of glint overlay --lights.
export function lampFile(lamps) {
    return "frame,id," + COLUMNS.join() + "\n" +
        lamps.map((lamp, i) => `*,${i + 1},` + COLUMNS.map(name => lamp[name]).join() + "\n").join("");
}
