// SPDX-License-Identifier: MIT
//
// worker.js - draws pictures beside the page, so that it never waits. The page has two: one
// draws coarsely at screen size, one the whole picture.
//
//     {kind: "tables"}                                   -> {kind: "tables", options, styles, lenses}
//     {kind: "picture", width, height, rgba}             the picture to come
//     {kind: "draw", id, values, widest, lamps, draft, model}  -> {kind: "drawn", id, ...}
//
// lamps null: as they are found. Replies to "draw" may also be {kind: "busy", text} while a
// lens is baked, and {kind: "failed", id, text}.
import {Glint} from "./glint.js";

// Options that an engine takes up from picture to picture.
const LIGHT = ["strength", "exposure", "gain", "starburst"];
// Options that choose the model.
const LENS = ["lens", "coating", "zoom", "focus", "f-number", "wavelengths", "sensor", "quality", "error"];

const urlOf = path => new URL(path, import.meta.url);
const glint = fetch(urlOf("glint.wasm")).then(answer => answer.arrayBuffer()).then(bytes => Glint.make(bytes));
let picture = null;
let opened = "", sized = "", last = {name: ""};
let found = [], doubtful = null;

async function keptModel(name) {
    try {
        const kept = await caches.match(urlOf("models/" + name));
        if (kept)
            return new Uint8Array(await kept.arrayBuffer());
    } catch { /* no storage: as if nothing was kept */ }
    const answer = await fetch(urlOf("models/" + name)).catch(() => null);
    return answer && answer.ok ? new Uint8Array(await answer.arrayBuffer()) : null;
}

async function keepModel(name, bytes) {
    try {
        const cache = await caches.open("glint-models");
        await cache.put(urlOf("models/" + name), new Response(bytes));
    } catch { /* baked again on the next visit */ }
}

// Opens the lens of VALUES; returns its model if that had to be baked or fetched.
async function open(g, values, widest, known) {
    const key = JSON.stringify([widest, ...LENS.map(name => values[name] ?? null)]);
    if (key === opened)
        return null;
    opened = sized = "";
    const name = g.open(widest);
    const near = [last, known].find(model => model && model.name === name);
    let bytes = near ? near.bytes : await keptModel(name);
    if (bytes)
        g.model(bytes);
    else {
        postMessage({kind: "busy", text: `Baking the lens ${values.lens}: seconds to minutes, once`});
        bytes = g.bake();
        await keepModel(name, bytes);
    }
    opened = key;
    last = {name, bytes};
    return last;
}

function clippedShare(rgba) {
    let n = 0;
    for (let i = 0; i < rgba.length; i += 4)
        n += rgba[i] === 255 || rgba[i + 1] === 255 || rgba[i + 2] === 255;
    return 4 * n / rgba.length;
}

async function draw(message) {
    const g = await glint;
    const started = performance.now();
    const {id, values, widest, lamps, draft} = message;
    g.options(values);
    const model = await open(g, values, widest, message.model);
    if (draft)
        g.set("quality", "draft");
    const key = JSON.stringify(values, (name, value) => LIGHT.includes(name) ? undefined : value);
    if (key !== sized) {
        sized = "";
        g.size(picture.width, picture.height);
        found = g.find(picture.rgba);
        doubtful = g.doubtful();
        sized = key;
    }
    const rgba = picture.rgba.slice();
    g.draw(rgba, lamps, draft);
    postMessage({kind: "drawn", id, rgba, width: picture.width, height: picture.height, found, doubtful, model,
        ms: performance.now() - started, clipped: clippedShare(rgba), memory: g.c.memory.buffer.byteLength}, [rgba.buffer]);
}

let queue = Promise.resolve();
onmessage = ({data}) => {
    queue = queue.then(async () => {
        try {
            if (data.kind === "tables")
                postMessage({kind: "tables", ...(await glint).tables()});
            else if (data.kind === "picture") {
                picture = data;
                sized = "";
            } else
                await draw(data);
        } catch (error) {
            opened = sized = "";
            postMessage({kind: "failed", id: data.id, text: error.message});
        }
    });
};
