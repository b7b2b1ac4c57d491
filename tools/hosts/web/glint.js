// SPDX-License-Identifier: MIT
//
// glint.js - the WebAssembly module as a JavaScript class, for browsers and Node.
//
//     const glint = await Glint.make(bytesOfGlintWasm);
//     glint.options({lens: "heliar-tronnier", strength: "0.7"});
//     glint.size(width, height);
//     const lamps = glint.find(rgba);
//     glint.draw(rgba);        or glint.draw(rgba, lamps)
//
// Failures throw an Error with the text that the command would print.

export const COLUMNS = ["x", "y", "power", "r", "g", "b", "size", "shape", "turn", "level", "seen"];
const ENOSYS = 52;
const FOUND = -1;

export class Glint {
    static async make(wasm) {
        const module = wasm instanceof WebAssembly.Module ? wasm : await WebAssembly.compile(wasm);
        // The library prints nothing; its C library refers to these.
        const files = {fd_close: () => ENOSYS, fd_seek: () => ENOSYS, fd_write: () => ENOSYS};
        const instance = await WebAssembly.instantiate(module, {wasi_snapshot_preview1: files});
        instance.exports._initialize();
        return new Glint(instance.exports);
    }

    constructor(exports) {
        this.c = exports;
        this.pixels = 0;
        this.room = 0;
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
        const a = encode(name), b = encode(String(value));
        try {
            this.check(this.c.web_set(a, b));
        } finally {
            this.c.web_free(a);
            this.c.web_free(b);
        }
    }

    // Sets all options: those of VALUES, and the defaults of others. MUTED: numbers of ghosts to leave out.
    options(values, muted = []) {
        this.c.web_reset();
        muted.forEach(ghost => this.check(this.c.web_mute(ghost)));
        for (const [name, value] of Object.entries(values))
            this.set(name, value);
    }

    size(width, height) {
        this.check(this.c.web_size(width, height));
    }

    // Runs WORK with RGBA in the module's memory; copies it back if it is to be drawn on.
    with(rgba, draws, work) {
        if (rgba.length > this.room) {
            this.c.web_free(this.pixels);
            this.pixels = this.c.web_take(rgba.length);
            this.room = this.pixels ? rgba.length : 0;
        }
        if (!this.pixels)
            throw new Error("no memory for a picture of this size");
        this.bytes(this.pixels, rgba.length).set(rgba);
        const value = work(this.pixels);
        if (draws)
            rgba.set(this.bytes(this.pixels, rgba.length));
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

    // Draws the flare of LAMPS, or of those that find() found, into RGBA.
    draw(rgba, lamps = null) {
        if (lamps)
            this.rows(lamps.length).set(lamps.flatMap(lamp => COLUMNS.map(name => lamp[name])));
        this.with(rgba, true, at => this.check(this.c.web_draw(at, lamps ? lamps.length : FOUND)));
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

// The ghosts MUTED as a file of glint overlay --ghosts.
export const ghostFile = muted => muted.map(ghost => ghost + " mute\n").join("");
