// SPDX-License-Identifier: MIT
//
// page.js - the page: what a person sets, and what the workers drew of it.
import {commandLine, widestOf} from "./command.js";
import {drawSection, makeOptions} from "./widgets.js";

const $ = id => document.getElementById(id);
const MAX_PIXELS = 40e6;
const MAX_BYTES = 200e6;
const DRAFT_SIDE = 640; // pixels of the longer side of coarse pictures
const FULL_DELAY_MS = 250; // without a change, before the whole picture is drawn
const NEW_LAMP_POWER = 2 ** 16; // that of glint overlay --light-at
const FIRST_LENS = "nikon-zoom-short";

let tables = null;
let photo = null; // {name, width, height, k: scale of coarse pictures}
let state = {values: {}, lamps: null, style: ""}; // lamps null: as found
let found = [], doubtful = null;
let selected = -1;
let past = [], future = [];
let zoom = 1;
let models = new Map();
let renderMark = 0;

// ------------------------------------------------------------------- workers

// Workers of a blob have the Content-Security-Policy of the page; those of a file have
// that of the server, which may be none.
const workerFile = URL.createObjectURL(new Blob([`import ${JSON.stringify(new URL("worker.js", location.href).href)};`],
    {type: "text/javascript"}));

// A worker that draws the latest state; requests in between are left out.
class Painter {
    constructor(draft) {
        this.worker = new Worker(workerFile, {type: "module"});
        this.draft = draft;
        this.busy = this.waiting = false;
        this.worker.onmessage = ({data}) => this.take(data);
        this.worker.onerror = event => report(event.message || "the page's worker failed", true);
    }

    send(message, transfer) {
        this.worker.postMessage(message, transfer);
    }

    draw() {
        this.waiting = true;
        if (this.busy || !photo)
            return;
        this.busy = true;
        this.waiting = false;
        this.mark = renderMark;
        const k = this.draft ? photo.k : 1;
        const lamps = state.lamps && state.lamps.map(lamp => k === 1 ? lamp :
            {...lamp, x: lamp.x * k, y: lamp.y * k, power: lamp.power * k * k, size: lamp.size * k, seen: lamp.seen * k});
        this.send({kind: "draw", id: photo.id, values: values(), widest: widest(), lamps, draft: this.draft,
            model: models.get(modelKey())});
    }

    take(data) {
        if (data.kind === "tables")
            return start(data);
        if (data.kind === "busy")
            return report(data.text);
        this.busy = false;
        if (photo && data.id === photo.id && !this.waiting)
            data.kind === "failed" ? report(data.text, true) : this.show(data);
        else if (data.kind === "drawn" && photo && data.id === photo.id && this.draft)
            this.show(data); // better an old coarse picture than none
        if (this.waiting)
            this.draw();
    }

    show(data) {
        if (data.model)
            models.set(modelKey(), data.model);
        if (this.draft) {
            if (shown.full >= this.mark)
                return;
            planFull();
        } else {
            shown.full = this.mark;
            const same = JSON.stringify(found) === JSON.stringify(data.found);
            found = data.found;
            doubtful = data.doubtful;
            if (!same)
                showLamps();
            report(`${data.width} × ${data.height}, ${(state.lamps || found).length} lamps, drawn in ${Math.round(data.ms)} ms; ` +
                `${(100 * data.clipped).toFixed(1)} % of the pixels are clipped`);
            document.body.dataset.ready = this.mark;
            document.body.dataset.memory = data.memory;
        }
        paint($("after"), data);
        if (!document.body.dataset.first)
            document.body.dataset.first = Math.round(performance.now() - photo.opened);
        document.body.dataset.step = Math.round(performance.now() - changedAt);
    }
}
const shown = {full: -1};
let fullTimer = 0, changedAt = 0;
const coarse = new Painter(true), full = new Painter(false);

function planFull() {
    clearTimeout(fullTimer);
    fullTimer = setTimeout(() => full.draw(), coarse.waiting ? 10 * FULL_DELAY_MS : FULL_DELAY_MS);
}

function paint(canvas, {rgba, width, height}) {
    if (canvas.width !== width || canvas.height !== height)
        [canvas.width, canvas.height] = [width, height];
    canvas.getContext("2d").putImageData(new ImageData(new Uint8ClampedArray(rgba.buffer), width, height), 0, 0);
}

function report(text, bad = false) {
    $("status").textContent = text;
    $("status").className = bad ? "bad" : "";
}

// ---------------------------------------------------------------- the state

const lensOf = name => tables.lenses.find(lens => lens.name === name);
const values = () => ({lens: FIRST_LENS, ...state.values});
const widest = () => widestOf(lensOf(values().lens), values());
const modelKey = () => JSON.stringify([values().lens, values().coating, values()["f-number"], values().zoom, values().focus]);

// Changes the state by CHANGE; a run of changes with one MARK is one step of undo.
let lastMark = "";
function change(patch, mark = "") {
    if (!mark || mark !== lastMark) {
        past.push(JSON.stringify(state));
        if (past.length > 200)
            past.shift();
    }
    lastMark = mark;
    future = [];
    state = {...state, ...patch};
    render();
}

function travel(from, to) {
    if (!from.length)
        return;
    to.push(JSON.stringify(state));
    state = JSON.parse(from.pop());
    lastMark = "";
    selected = -1;
    options.forEach(option => option.show());
    render();
}

function setOption(name, value) {
    const next = {...state.values};
    if (value === null)
        delete next[name];
    else
        next[name] = value;
    if (name === "strength")
        delete next.exposure;
    if (name === "exposure")
        delete next.strength;
    if (name === "lens") // ranges of another lens
        for (const other of ["f-number", "zoom", "focus"])
            delete next[other];
    change({values: next}, name);
    if (["lens", "strength", "exposure"].includes(name))
        options.forEach(option => option.show());
}

// Shows the state, and has it drawn.
function render() {
    renderMark++;
    changedAt = performance.now();
    $("undo").disabled = !past.length;
    $("redo").disabled = !future.length;
    for (const button of $("styles").children)
        button.setAttribute("aria-pressed", button.dataset.name === state.style);
    for (const button of $("lenses").children)
        button.setAttribute("aria-checked", button.dataset.name === values().lens);
    showLamps();
    if (!photo)
        return;
    $("command").value = commandLine(photo.name, values(), state.lamps, widest());
    clearTimeout(fullTimer);
    coarse.draw();
}

// --------------------------------------------------------------------- lamps

const lamps = () => state.lamps || found;

function showLamps() {
    const box = $("lamps"), list = lamps();
    if (!photo)
        return;
    if (selected >= list.length)
        selected = -1;
    while (box.children.length > list.length + 1)
        box.lastChild.remove();
    while (box.children.length < list.length + 1)
        box.append(makeHandle(box.children.length));
    list.forEach((lamp, i) => place(box.children[i], lamp.x, lamp.y, `Lamp ${i + 1}, ${Math.log2(lamp.power).toFixed(1)} stops`, i));
    const doubt = box.children[list.length];
    doubt.hidden = !doubtful || Boolean(state.lamps);
    if (!doubt.hidden)
        place(doubt, doubtful[0], doubtful[1], "Perhaps a lamp: use it", -2);
    $("remove").disabled = selected < 0;
    $("power-label").hidden = selected < 0;
    if (selected >= 0) {
        $("power").value = Math.log2(list[selected].power);
        $("power-out").textContent = Math.log2(list[selected].power).toFixed(1);
    }
}

function place(handle, x, y, label, i) {
    handle.style.left = 100 * x / photo.width + "%";
    handle.style.top = 100 * y / photo.height + "%";
    handle.setAttribute("aria-label", label);
    handle.title = label;
    handle.hidden = false;
    handle.className = i < 0 ? "lamp doubt" : "lamp";
    handle.setAttribute("aria-pressed", i === selected);
}

function changeLamp(i, patch, mark) {
    change({lamps: lamps().map((lamp, j) => j === i ? {...lamp, ...patch} : lamp)}, mark);
}

function addLamp(x, y) {
    const list = [...lamps(), {x, y, power: NEW_LAMP_POWER, r: 1, g: 1, b: 1, size: 0, shape: 1, turn: 0, level: 1, seen: 0}];
    selected = list.length - 1;
    change({lamps: list});
    $("lamps").children[selected].focus();
}

function removeLamp(i) {
    selected = -1;
    change({lamps: lamps().filter((lamp, j) => j !== i)});
}

function pointOf(event) {
    const box = $("frame").getBoundingClientRect();
    return [(event.clientX - box.left) / box.width * photo.width, (event.clientY - box.top) / box.height * photo.height];
}

let drags = 0;
function makeHandle(i) {
    const handle = document.createElement("button");
    handle.type = "button";
    const isLamp = () => i < lamps().length;
    const select = () => {
        selected = i;
        showLamps();
    };
    handle.onfocus = () => isLamp() && select();
    handle.onpointerdown = event => {
        if (!isLamp())
            return;
        const mark = "drag" + drags++;
        handle.setPointerCapture(event.pointerId);
        handle.onpointermove = move => {
            const [x, y] = pointOf(move);
            changeLamp(i, {x, y}, mark);
        };
        handle.onpointerup = handle.onpointercancel = () => handle.onpointermove = null;
    };
    handle.onclick = () => isLamp() ? select() : addLamp(...doubtful);
    handle.ondblclick = event => event.stopPropagation();
    handle.onkeydown = event => {
        const lamp = lamps()[i], step = event.shiftKey ? 10 : 1;
        const by = {ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, -step], ArrowDown: [0, step]}[event.key];
        if (!lamp)
            return;
        if (by)
            changeLamp(i, {x: lamp.x + by[0], y: lamp.y + by[1]}, "move" + i);
        else if (event.key === "+" || event.key === "-")
            changeLamp(i, {power: lamp.power * 2 ** (event.key === "+" ? 1 / 3 : -1 / 3)}, "power" + i);
        else if (event.key === "Delete" || event.key === "Backspace")
            removeLamp(i);
        else
            return;
        event.preventDefault();
    };
    return handle;
}

// -------------------------------------------------------------------- opening

async function open(file) {
    if (!file)
        return;
    try {
        if (!/^image\/(png|jpeg|webp|avif|bmp|gif)$/.test(file.type))
            throw new Error(`${file.name}: not a photograph (PNG, JPEG, WebP, AVIF, BMP or GIF)`);
        if (file.size > MAX_BYTES)
            throw new Error(`${file.name}: larger than 200 MB`);
        report(`Opening ${file.name}`);
        const opened = performance.now();
        const bitmap = await createImageBitmap(file, {colorSpaceConversion: "none", premultiplyAlpha: "none"}).catch(() => {
            throw new Error(`${file.name}: the picture is damaged, too large or of an unknown kind`);
        });
        const {width, height} = bitmap;
        if (width * height > MAX_PIXELS || Math.max(width, height) > 32768)
            throw new Error(`${file.name}: ${width} × ${height} is more than ${MAX_PIXELS / 1e6} megapixels; glint overlay has no such limit`);
        const k = Math.min(1, DRAFT_SIDE / Math.max(width, height));
        const small = {width: Math.max(1, Math.round(width * k)), height: Math.max(1, Math.round(height * k))};
        const pixels = size => {
            const canvas = new OffscreenCanvas(size.width, size.height), context = canvas.getContext("2d", {willReadFrequently: true});
            context.imageSmoothingQuality = "high";
            context.drawImage(bitmap, 0, 0, size.width, size.height);
            return context.getImageData(0, 0, size.width, size.height).data;
        };
        const whole = pixels(bitmap), part = pixels(small);
        photo = {id: (photo ? photo.id : 0) + 1, name: file.name, width, height, k, opened};
        paint($("before"), {rgba: whole.slice(), width, height});
        paint($("after"), {rgba: whole.slice(), width, height});
        bitmap.close();
        coarse.send({kind: "picture", ...small, rgba: new Uint8Array(part.buffer)}, [part.buffer]);
        full.send({kind: "picture", width, height, rgba: new Uint8Array(whole.buffer)}, [whole.buffer]);
        found = [];
        doubtful = null;
        selected = -1;
        past = [];
        future = [];
        state = {...state, lamps: null};
        delete document.body.dataset.first;
        $("empty").hidden = true;
        $("frame").hidden = false;
        for (const id of ["add", "find", "export"])
            $(id).disabled = false;
        setZoom(1);
        render();
    } catch (error) {
        report(error.message, true);
    }
}

const stem = () => photo.name.replace(/\.[^.]*$/, "");

async function save() {
    report("Drawing the picture to save");
    if (shown.full < renderMark) {
        full.draw();
        while (shown.full < renderMark && !$("status").classList.contains("bad"))
            await new Promise(done => setTimeout(done, 50));
    }
    if (shown.full < renderMark)
        return;
    const blob = await new Promise(done => $("after").toBlob(done, "image/png"));
    const link = document.createElement("a");
    link.href = URL.createObjectURL(blob);
    link.download = stem() + "-glint.png";
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 60000);
    report(`Saved ${link.download}`);
}

// ----------------------------------------------------------------------- view

function setZoom(to) {
    zoom = Math.min(16, Math.max(1, to));
    if (!photo)
        return;
    const stage = $("stage"), style = $("frame").style;
    const fit = Math.min(stage.clientWidth / photo.width, stage.clientHeight / photo.height);
    style.width = photo.width * fit * zoom + "px";
    style.height = photo.height * fit * zoom + "px";
    $("after").style.imageRendering = fit * zoom > 2 ? "pixelated" : "auto";
}

function setDivider() {
    const at = $("divider").value;
    $("after").style.clipPath = `inset(0 0 0 ${at}%)`;
    $("bar").style.left = at + "%";
    $("bar").style.display = at > 0 && at < 100 ? "block" : "none";
}

// ---------------------------------------------------------------------- start

let options = [];

function showLenses() {
    const words = $("search").value.toLowerCase().split(/\s+/).filter(Boolean);
    for (const button of $("lenses").children)
        button.hidden = !words.every(word => button.dataset.words.includes(word));
}

function makeLenses() {
    const known = tables.lenses.slice().sort((a, b) => (a.folder > b.folder) - (a.folder < b.folder));
    for (const lens of known) {
        const button = document.createElement("button");
        button.type = "button";
        button.dataset.name = lens.name;
        button.dataset.words = [lens.name, lens.folder, lens.source, lens.character].join(" ").toLowerCase();
        button.setAttribute("role", "radio");
        button.title = lens.source;
        const text = document.createElement("span"), small = document.createElement("small");
        small.textContent = `${Math.round(lens.focal)} mm. ${lens.character}`;
        text.append(lens.name, small);
        button.append(drawSection(lens), text);
        button.onclick = () => setOption("lens", lens.name);
        $("lenses").append(button);
    }
}

// Scrolls the list of lenses to the chosen one.
function showChosen() {
    const list = $("lenses"), button = [...list.children].find(one => one.dataset.name === values().lens);
    if (button)
        list.scrollTop = button.offsetTop - list.offsetTop;
}

function makeStyles() {
    for (const style of tables.styles) {
        const button = document.createElement("button");
        button.type = "button";
        button.dataset.name = button.textContent = style.name;
        button.title = style.about;
        button.onclick = () => {
            change({values: {...style.set}, style: style.name});
            options.forEach(option => option.show());
            showChosen();
        };
        $("styles").append(button);
    }
}

function start(read) {
    tables = read;
    makeStyles();
    makeLenses();
    options = makeOptions(tables.options, $("main-options"), $("more-options"), {
        value: name => values()[name], set: setOption, lens: () => lensOf(values().lens)});
    showChosen();
    report("Open a photograph, or take the sample");
    document.body.dataset.loaded = Math.round(performance.now());
    render();
}

$("file").onchange = event => open(event.target.files[0]);
$("sample").onclick = async () => {
    const answer = await fetch("sample.jpg").catch(() => null);
    if (answer && answer.ok)
        open(new File([await answer.blob()], "sample.jpg", {type: "image/jpeg"}));
    else
        report("sample.jpg is missing", true);
};
$("undo").onclick = () => travel(past, future);
$("redo").onclick = () => travel(future, past);
$("export").onclick = save;
$("add").onclick = () => addLamp(photo.width / 2, photo.height / 2);
$("find").onclick = () => {
    selected = -1;
    change({lamps: null});
};
$("remove").onclick = () => removeLamp(selected);
$("power").oninput = event => changeLamp(selected, {power: 2 ** event.target.value}, "power" + selected);
$("search").oninput = showLenses;
$("divider").oninput = setDivider;
$("show").onchange = event => $("lamps").className = event.target.checked ? "" : "none";
$("in").onclick = () => setZoom(zoom * 1.5);
$("out").onclick = () => setZoom(zoom / 1.5);
$("fit").onclick = () => setZoom(1);
$("copy").onclick = () => {
    $("command").select();
    navigator.clipboard ? navigator.clipboard.writeText($("command").value) : document.execCommand("copy");
};
$("frame").ondblclick = event => addLamp(...pointOf(event));
$("stage").onwheel = event => {
    if (!event.ctrlKey)
        return;
    event.preventDefault();
    setZoom(zoom * 2 ** (-event.deltaY / 300));
};
addEventListener("resize", () => setZoom(zoom));
addEventListener("dragover", event => {
    event.preventDefault();
    $("stage").classList.add("over");
});
addEventListener("dragleave", () => $("stage").classList.remove("over"));
addEventListener("drop", event => {
    event.preventDefault();
    $("stage").classList.remove("over");
    open(event.dataTransfer.files[0]);
});
addEventListener("paste", event => open(event.clipboardData.files[0]));
addEventListener("keydown", event => {
    if (!(event.ctrlKey || event.metaKey) || event.key.toLowerCase() !== "z" || /^(text|search|number)/.test(event.target.type))
        return;
    event.preventDefault();
    event.shiftKey ? travel(future, past) : travel(past, future);
});
setDivider();
coarse.send({kind: "tables"});
