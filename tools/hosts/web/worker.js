// SPDX-License-Identifier: MIT
//
// worker.js - draws pictures beside the page, so that it never waits.
//
//     {kind: "module", module}                 the compiled glint.wasm
//     {kind: "tables"}                         -> {kind: "tables", options, styles, lenses}
//     {kind: "picture", width, height, rgba}   the picture to come
//     {kind: "find", id, values}               -> {kind: "found", id, found, doubtful}
//     {kind: "draw", id, values, lamps, most, ghosts}  -> {kind: "drawn", id, ...}
//     {kind: "save", id, values, lamps, alone} -> {kind: "saved", id, png}, of 16 bits
//     {kind: "frame", ...}                     picture and draw in one, for a camera
//
// lamps null: as they are found. most: draws a draft of the first MOST lamps; 0: the whole picture.
// ghosts: how many of them to list. Replies may also be {kind: "failed", id, text}.
import {init} from "./glint.js";
import {encodePng} from "./png.js";

// Options that an engine takes up from picture to picture.
const LIGHT = ["strength", "exposure", "gain", "starburst"];
const DRAFT = {quality: "0.125", "area-samples": "1"};

let setModule;
const engine = new Promise(done => setModule = module => done(init(module)));
const NEAR = 2; // pixels
let picture = null;
let sized = "", found = null;
let settled = []; // lamps of the last frame of a camera

function clippedShare(rgba) {
    let n = 0;
    for (let i = 0; i < rgba.length; i += 4)
        n += rgba[i] === 255 || rgba[i + 1] === 255 || rgba[i + 2] === 255;
    return 4 * n / rgba.length;
}

function prepare(g, values) {
    g.options(values);
    const key = JSON.stringify(values, (name, value) => LIGHT.includes(name) ? undefined : value);
    if (key === sized)
        return;
    sized = "";
    g.size(picture.width, picture.height);
    found = null;
    sized = key;
}

function find(g, {id, values}) {
    prepare(g, values);
    found ??= g.find(picture.rgba);
    postMessage({kind: "found", id, found, doubtful: g.doubtful()});
}

function draw(g, {id, values, lamps, most, ghosts}) {
    const started = performance.now(), rgba = picture.rgba.slice();
    prepare(g, most ? {...values, ...DRAFT} : values);
    if (!lamps)
        found ??= g.find(picture.rgba);
    g.draw(rgba, most ? (lamps ?? found).slice(0, most) : lamps);
    postMessage({kind: "drawn", id, rgba, width: picture.width, height: picture.height, ghosts: ghosts ? g.ghosts(ghosts) : [],
        ms: performance.now() - started,
        clipped: clippedShare(rgba), memory: g.c.memory.buffer.byteLength}, [rgba.buffer]);
}

// ALONE: see Engine.drawDeep.
async function save(g, {id, values, lamps, alone}) {
    prepare(g, values);
    if (!lamps)
        found ??= g.find(picture.rgba);
    const png = await encodePng(g.drawDeep(picture.rgba, lamps, alone), picture.width, picture.height);
    postMessage({kind: "saved", id, png});
}

// Returns SEEN, the lamps of a frame. Those that hardly moved have the place and extent of the last frame, for which
// the ghosts have been measured, and their power follows slowly, as noise changes it.
function settle(seen) {
    settled = seen.map(lamp => {
        const old = settled.find(({x, y}) => Math.hypot(x - lamp.x, y - lamp.y) < NEAR);
        return old ? {...old, power: old.power + (lamp.power - old.power) / 4} : lamp;
    });
    return settled;
}

function drawFrame(g, frame) {
    const {id, values, width, height, rgba, most} = frame, started = performance.now();
    if (!picture || picture.width !== width || picture.height !== height)
        sized = "";
    picture = frame;
    prepare(g, {...values, ...DRAFT});
    const lamps = frame.lamps ?? settle(g.find(rgba));
    g.draw(rgba, lamps.slice(0, most));
    postMessage({kind: "drawn", id, rgba, width, height, lamps, ms: performance.now() - started}, [rgba.buffer]);
}

let queue = Promise.resolve();
onmessage = ({data}) => {
    if (data.kind === "module")
        return setModule(data.module);
    queue = queue.then(async () => {
        try {
            const g = await engine;
            if (data.kind === "tables")
                postMessage({kind: "tables", ...g.tables()});
            else if (data.kind === "picture") {
                picture = data;
                sized = "";
            } else
                await ({find, draw, save, frame: drawFrame})[data.kind](g, data);
        } catch (error) {
            sized = "";
            postMessage({kind: "failed", id: data.id, text: error.message});
        }
    });
};
