// SPDX-License-Identifier: MIT
//
// types.js - prints the TypeScript declarations of glint.js. Options and lenses are those of the module.
import fs from "node:fs";
import {init} from "../glint.js";

const {options, lenses} = (await init(fs.readFileSync(process.argv[2]))).tables();
const TYPES = {real: "number", integer: "number", flag: "boolean", text: "string"};
const union = words => words.map(word => JSON.stringify(word)).join(" | ");

function typeOf({name, type, accepts}) {
    if (name === "lens")
        return union(lenses.map(lens => lens.name));
    if (type === "word")
        return union(accepts.split("|"));
    // A word may stand for a number.
    return TYPES[type] + (type === "real" && /(^|, )or [a-z]/.test(accepts) ? " | string" : "");
}

function limits({type, low, high, initial, text}) {
    if (type !== "real" && type !== "integer")
        return text ? ` (default ${text})` : "";
    return `: ${low ?? "any"} to ${high ?? "any"}${initial === null ? "" : `, default ${initial}`}`;
}

const row = option => `    /** ${option.help}${limits(option)} */\n    ${JSON.stringify(option.name)}?: ${typeOf(option)};\n`;

process.stdout.write(`// Made by npm/types.js.

/** The options of glint overlay that apply to pictures in memory. */
export interface Options {
${options.map(row).join("")}}

/** A lamp, in the units of glint overlay --lights. */
export interface Lamp {
    /** pixels from the top left corner, also off-screen */
    x: number;
    y: number;
    /** light of so many white pixels (default 65536) */
    power?: number;
    /** colour (default 1) */
    r?: number;
    g?: number;
    b?: number;
    /** RMS radius in pixels (default 0) */
    size?: number;
    /** minor over major axis (default 1) */
    shape?: number;
    /** degrees of the major axis (default 0) */
    turn?: number;
    /** how far the lamp has risen, above 0 to 1 (default 1) */
    level?: number;
    /** RMS radius in pixels of the clipped lamp, which sets the power of its starburst (default 0: that of the lamp) */
    seen?: number;
}

/** A ghost of the last picture: its fraction of the light and its box in pixels */
export interface Ghost {
    number: number;
    share: number;
    x0: number;
    y0: number;
    x1: number;
    y1: number;
}

/** A picture in the layout of ImageData: bytes R, G, B, A */
export type Pixels = Uint8Array | Uint8ClampedArray;

/** A lens and the memory of its pictures */
export class Engine {
    private constructor();
    /** Sets all options: those of values, and the defaults of others. ghosts: the text of the file */
    options(values: Options): void;
    /** Sets one option; strength, exposure, gain and starburst also between size() and draw() */
    set<Name extends keyof Options>(name: Name, value: NonNullable<Options[Name]>): void;
    /** Opens the lens of the options, for pictures of this size */
    size(width: number, height: number): void;
    /** The picture in the module's memory, which find() and draw() do not copy. Read it again after each call */
    readonly pixels: Uint8ClampedArray;
    /** Returns the lamps of a picture, the strongest first */
    find(picture: Pixels): Required<Lamp>[];
    /** Returns up to three positions x, y that find() did not accept as lamps, the brightest first */
    doubtful(): [number, number][];
    /** Draws the flare of these lamps, or of those that find() found, into the picture */
    draw(picture: Pixels, lamps?: Lamp[] | null): void;
    /** Returns the samples of draw() with 16 bits, high byte first: R, G, B of the picture, or R, G, B, A of the flare alone */
    drawDeep(picture: Pixels, lamps?: Lamp[] | null, alone?: boolean): Uint8Array;
    /** Returns up to max ghosts of the last picture, the brightest first */
    ghosts(max: number): Ghost[];
}

/** Returns an engine. wasm: the bytes of glint.wasm or its WebAssembly.Module; default: the file beside glint.js */
export function init(wasm?: object): Promise<Engine>;
`);
