// SPDX-License-Identifier: MIT
//
// worker.js - draws pictures beside the page, so that it never waits.
//
//     {kind: "tables"}                         -> {kind: "tables", options, styles, lenses}
//     {kind: "picture", width, height, rgba}   the picture to come
//     {kind: "find", id, values, muted}        -> {kind: "found", id, found, doubtful}
//     {kind: "draw", id, values, muted, lamps, draft, ghosts}  -> {kind: "drawn", id, ...}
//
// muted: numbers of ghosts. lamps null: as they are found. draft: quickly, with a part of the light.
// ghosts: how many of them to list. Replies may also be {kind: "failed", id, text}.
import {init} from "./glint.js";

// Options that an engine takes up from picture to picture.
const LIGHT = ["strength", "exposure", "gain", "starburst"];
// Drafts have the options of --preview, and only the strongest lamps, as time grows with the number of lamps.
const DRAFT = {quality: "draft", "area-samples": "1"}, DRAFT_LAMPS = 4;

const engine = init();
let picture = null;
let sized = "", found = null;

function clippedShare(rgba) {
    let n = 0;
    for (let i = 0; i < rgba.length; i += 4)
        n += rgba[i] === 255 || rgba[i + 1] === 255 || rgba[i + 2] === 255;
    return 4 * n / rgba.length;
}

function prepare(g, values, muted) {
    g.options(values, muted);
    const key = JSON.stringify([values, muted], (name, value) => LIGHT.includes(name) ? undefined : value);
    if (key === sized)
        return;
    sized = "";
    g.size(picture.width, picture.height);
    found = null;
    sized = key;
}

function find(g, {id, values, muted}) {
    prepare(g, values, muted);
    found ??= g.find(picture.rgba);
    postMessage({kind: "found", id, found, doubtful: g.doubtful()});
}

function draw(g, {id, values, muted, lamps, draft, ghosts}) {
    const started = performance.now(), rgba = picture.rgba.slice();
    prepare(g, draft ? {...values, ...DRAFT} : values, muted);
    if (draft)
        lamps = lamps.sort((a, b) => b.power - a.power).slice(0, DRAFT_LAMPS);
    else if (!lamps)
        found ??= g.find(picture.rgba);
    g.draw(rgba, lamps);
    postMessage({kind: "drawn", id, rgba, width: picture.width, height: picture.height, ghosts: ghosts ? g.ghosts(ghosts) : [],
        ms: performance.now() - started, clipped: clippedShare(rgba), memory: g.c.memory.buffer.byteLength}, [rgba.buffer]);
}

let queue = Promise.resolve();
onmessage = ({data}) => {
    queue = queue.then(async () => {
        try {
            const g = await engine;
            if (data.kind === "tables")
                postMessage({kind: "tables", ...g.tables()});
            else if (data.kind === "picture") {
                picture = data;
                sized = "";
            } else
                (data.kind === "find" ? find : draw)(g, data);
        } catch (error) {
            sized = "";
            postMessage({kind: "failed", id: data.id, text: error.message});
        }
    });
};
