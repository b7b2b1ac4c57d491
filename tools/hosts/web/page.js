// SPDX-License-Identifier: MIT
//
// page.js - the page: what a person sets, and what the workers drew of it.
import {commandLine, ENDINGS, readCommand, readGhost, writeGhost} from "./command.js";
import {LAMP} from "./glint.js";
import {copyMetadata} from "./jpeg.js";
import {drawSection, makeOptions, title} from "./widgets.js";

const $ = id => document.getElementById(id);
const MAX_PIXELS = 40e6;
const MAX_BYTES = 200e6;
const DRAFT_SIDE = 640; // pixels of the longer side of coarse pictures
const DRAFT_MS = 60; // that drawing one may take, or half more; the number of its lamps follows
const FRAME_MS = 50; // the same, of a camera
const THUMB_LAMPS = 4;
const GHOSTS = 12; // that are listed
const THUMB_SIDE = 192; // pixels of the longer side of the pictures in the list of lenses
const FULL_DELAY_MS = 250; // without a change, before the whole picture is drawn
const PATIENCE_MS = 2000; // after which an outdated picture is abandoned
const FIRST_LENS = "nikon-zoom-short";

let tables = null;
let photo = null; // {id, file, width, height, searched: the search that found FOUND}
let state = {values: {}, lamps: null}; // lamps null: as found
let found = [], doubtful = []; // lamps, and positions of regions that may be lamps
let selected = -1;
let past = [], future = [];
let zoom = 1;
let renderMark = 0;

// ------------------------------------------------------------------- workers

const compiled = fetch("glint.wasm").then(answer => answer.arrayBuffer()).then(bytes => WebAssembly.compile(bytes));

// Workers of a blob have the Content-Security-Policy of the page; those of a file have
// that of the server, which may be none.
const workerFile = URL.createObjectURL(new Blob([`import ${JSON.stringify(new URL("worker.js", location.href).href)};`],
    {type: "text/javascript"}));

// Returns LAMPS in a picture scaled by K.
const scaleLamps = (lamps, k) => k === 1 ? lamps : lamps.map(lamp =>
    ({...lamp, x: lamp.x * k, y: lamp.y * k, power: lamp.power * k * k, size: lamp.size * k, seen: lamp.seen * k}));

// Returns the number of lamps that can be drawn in GOAL, if MOST took MS: half to twice as many. It seldom changes, as
// the ghosts of other lamps must be measured first.
const fit = (most, ms, goal) => ms > goal / 2 && ms < 1.5 * goal ? most :
    Math.round(Math.min(Math.max(most * goal / ms, most / 2, 1), 2 * most, 16));

// A worker that draws pictures whose longer side has at most SIDE pixels: drafts of the first MOST lamps,
// or, if MOST is 0, all lamps.
class Painter {
    constructor(side, most) {
        this.side = side;
        this.most = most;
        this.isDraft = most > 0;
        this.start();
    }

    start() {
        const worker = this.worker = new Worker(workerFile, {type: "module"});
        compiled.then(module => worker.postMessage({kind: "module", module}));
        this.worker.onmessage = ({data}) => this.take(data);
        this.worker.onerror = event => report(event.message || "the page's worker failed", true);
        this.busy = false;
        this.drawing = null;
    }

    // Sets the photograph. PIXELS returns the RGBA pixels of a picture of a size.
    open(pixels) {
        this.k = Math.min(1, this.side / Math.max(photo.width, photo.height));
        this.picture = {kind: "picture", width: Math.max(1, Math.round(photo.width * this.k)), height: Math.max(1, Math.round(photo.height * this.k))};
        this.picture.rgba = new Uint8Array(pixels(this.picture).buffer);
        if (this.busy)
            this.restart();
        else
            this.worker.postMessage(this.picture);
    }

    // Abandons the picture being drawn.
    restart() {
        this.saved?.(null);
        this.worker.terminate();
        this.start();
        this.worker.postMessage(this.picture);
    }

    post(message, moved = []) {
        this.busy = true;
        this.since = performance.now();
        this.worker.postMessage({...message, id: photo.id}, moved);
    }

    // LAMPS null: those that the worker finds. MOST: see worker.js.
    send(values, lamps, most, ghosts = 0) {
        if (lamps && most) // the strongest, and the one being changed
            lamps = [...lamps].sort((a, b) => (b === lamps[selected]) - (a === lamps[selected]) || b.power - a.power);
        this.post({kind: "draw", values, lamps: lamps && scaleLamps(lamps, this.k), most, ghosts});
    }
}

// Draws the latest state; states in between are left out.
class View extends Painter {
    draw() {
        if (this.busy && this.drawing === renderMark) // this very picture
            return;
        if (this.busy && !this.isDraft && performance.now() - this.since > PATIENCE_MS)
            this.restart();
        this.waiting = this.busy;
        if (this.busy || !photo)
            return;
        if (!this.isDraft)
            reportProgress("Drawing the whole picture");
        this.mark = this.drawing = renderMark;
        this.send(values(), this.lamps(), this.most);
    }

    lamps() {
        return state.lamps || (this.isDraft && photo.searched === searchKey() ? found : null);
    }

    // Searches lamps. Until they are found, the coarse view draws those that it finds in the small picture.
    search() {
        if (state.lamps || photo.searched === searchKey() || this.busy && this.searching === searchKey())
            return;
        if (this.busy)
            this.restart();
        this.drawing = null;
        this.searching = searchKey();
        this.post({kind: "find", values: values()});
    }

    // Returns the file of the picture with 16 bits, or of the flare ALONE; null if that was abandoned.
    save(alone) {
        this.post({kind: "save", values: values(), lamps: this.lamps(), alone});
        return new Promise(done => this.saved = done);
    }

    takeFound(data) {
        photo.searched = this.searching;
        ({found, doubtful} = data);
        showLamps();
        renderMark++;
        coarse.draw();
    }

    take(data) {
        if (data.kind === "tables")
            return start(data);
        this.busy = false;
        this.drawing = null;
        this.saved?.(data.png);
        this.saved = null;
        if (data.kind === "found" && data.id === photo.id)
            this.takeFound(data);
        else if (photo && data.id === photo.id && !this.waiting)
            data.kind === "failed" ? report(data.text, true) : data.kind === "drawn" && this.show(data);
        else if (data.kind === "drawn" && photo && data.id === photo.id && this.isDraft)
            this.show(data); // better an old coarse picture than none
        showSign();
        if (this.waiting)
            this.draw();
        gallery.next();
    }

    show(data) {
        if (this.isDraft && shown.full >= this.mark)
            return;
        if (this.isDraft) {
            this.most = fit(this.most, data.ms, DRAFT_MS);
            planFull();
        } else {
            shown.full = this.mark;
            reportProgress(!lamps().length ? "No lamp was found: add one" + (doubtful.length ? ", or click a dashed ring" : "") :
                `${data.width} × ${data.height}, ${lamps().length} lamps, drawn in ${Math.round(data.ms)} ms; ` +
                `${(100 * data.clipped).toFixed(1)} % of the pixels are clipped`);
            document.body.dataset.ready = this.mark;
            document.body.dataset.memory = data.memory;
        }
        paint($("after"), data);
        if (!document.body.dataset.first)
            document.body.dataset.first = Math.round(performance.now() - photo.opened);
        if (this.mark === renderMark)
            document.body.dataset.step ||= Math.round(performance.now() - changedAt);
    }
}

// Lists the ghosts, and draws the photograph with each lens that the list shows, while the views are idle.
class Gallery extends Painter {
    next() {
        if (this.busy || coarse.busy || full.busy || !photo || !photo.searched || !lamps().length)
            return;
        const {ghost, ghosts, ...all} = values(), key = JSON.stringify([photo.id, all, state.lamps]);
        this.button = null;
        if ($("ghost-box").open && this.listed !== key) {
            this.listed = key;
            return this.send(all, lamps(), this.most, GHOSTS);
        }
        this.button = [...$("lenses").children].find(one => one.dataset.seen === "true" && Number(one.dataset.thumb) !== photo.id);
        if (this.button)
            this.send({lens: this.button.dataset.name}, lamps(), this.most);
    }

    take(data) {
        this.busy = false;
        if (data.id === photo.id && this.button) {
            this.button.dataset.thumb = photo.id;
            if (data.kind === "drawn")
                paint(this.button.querySelector("canvas"), data);
        } else if (data.id === photo.id && data.kind === "drawn")
            showGhosts(data.ghosts.map(ghost => ({...ghost, left: ghost.x0 / data.width, top: ghost.y0 / data.height,
                right: (ghost.x1 + 1) / data.width, bottom: (ghost.y1 + 1) / data.height})));
        this.next();
    }
}

const stopCamera = video => video.srcObject.getTracks().forEach(track => track.stop());

// Returns the type of recordings; undefined if the browser cannot record the picture.
const recordType = () => window.MediaRecorder && HTMLCanvasElement.prototype.captureStream &&
    ["video/webm", "video/mp4"].find(one => MediaRecorder.isTypeSupported(one));

// Draws the frames of a camera as they come. While one is drawn, others are left out.
class Live extends Painter {
    async on() {
        if (!navigator.mediaDevices)
            throw new Error("browsers allow it only to pages of https or of this computer");
        const video = Object.assign(document.createElement("video"), {playsInline: true, muted: true,
            srcObject: await navigator.mediaDevices.getUserMedia({video: {width: 640, height: 480}})});
        await video.play().catch(error => {
            stopCamera(video);
            throw error;
        });
        const {videoWidth: width, videoHeight: height} = video;
        this.video = video;
        begin({file: new File([], "camera.png"), width, height, live: true});
        [coarse, full, gallery].filter(painter => painter.busy).forEach(painter => painter.restart());
        $("command").value = "";
        this.context = new OffscreenCanvas(width, height).getContext("2d", {willReadFrequently: true});
        this.count = 0;
        this.from = photo.opened = performance.now();
        this.watch();
    }

    // Returns a file of the last frame without flare.
    async off() {
        this.recorder?.stop();
        stopCamera(this.video);
        this.video = null;
        $("meter").textContent = "";
        return new File([await this.context.canvas.convertToBlob()], "camera.png", {type: "image/png"});
    }

    watch() {
        this.video?.requestVideoFrameCallback(() => {
            this.fresh = true;
            this.grab();
            this.watch();
        });
    }

    grab() {
        if (this.busy || !this.fresh || !this.video)
            return;
        const {width, height} = photo;
        this.fresh = false;
        this.context.drawImage(this.video, 0, 0, width, height);
        const rgba = new Uint8Array(this.context.getImageData(0, 0, width, height).data.buffer);
        this.post({kind: "frame", values: values(), lamps: state.lamps, most: this.most, width, height, rgba}, [rgba.buffer]);
    }

    take(data) {
        this.busy = false;
        if (!this.video || data.id !== photo.id)
            return;
        if (data.kind === "failed")
            report(data.text, true);
        else
            this.show(data);
        this.grab();
    }

    show(data) {
        $("before").getContext("2d").drawImage(this.context.canvas, 0, 0);
        paint($("after"), data);
        found = data.lamps;
        showLamps();
        this.most = fit(this.most, data.ms, FRAME_MS);
        this.count++;
        const seconds = (performance.now() - this.from) / 1000;
        if (seconds < 1)
            return;
        $("meter").textContent = `${(this.count / seconds).toFixed(1)} frames a second`;
        this.count = 0;
        this.from = performance.now();
    }

    // Starts or ends a recording, which is then saved.
    record() {
        if (this.recorder)
            return this.recorder.stop();
        const parts = [], type = recordType();
        this.recorder = new MediaRecorder($("after").captureStream(), {mimeType: type});
        this.recorder.ondataavailable = event => parts.push(event.data);
        this.recorder.onstop = () => {
            this.recorder = null;
            $("record").setAttribute("aria-pressed", false);
            download(new Blob(parts, {type}), "camera-glint." + type.slice(6));
        };
        this.recorder.start();
        $("record").setAttribute("aria-pressed", true);
    }
}

let live = null;

async function startCamera() {
    try {
        $("camera").disabled = true;
        live ??= new Live(Infinity, 1);
        report("Opening the camera");
        await live.on();
        report("The camera is drawn live. Camera again: the last frame becomes the photograph");
    } catch (error) {
        report(error.name === "NotAllowedError" ? "The browser does not allow the camera for this page" : "No camera can be opened: " + error.message, true);
    }
    showCamera();
}

const isLive = () => Boolean(live?.video && photo?.live);

function showCamera() {
    $("camera").disabled = false;
    $("camera").setAttribute("aria-pressed", isLive());
    $("record").hidden = !isLive() || !recordType();
    $("export").disabled = isLive() || !photo;
}

const shown = {full: -1};
let fullTimer = 0, changedAt = 0;
const coarse = new View(DRAFT_SIDE, 1), full = new View(Infinity, 0), gallery = new Gallery(THUMB_SIDE, THUMB_LAMPS);

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

const hasError = () => $("status").className === "bad";

// Reports TEXT unless an error is shown, which remains until the next change.
function reportProgress(text) {
    if (!hasError())
        report(text);
}

// ---------------------------------------------------------------- the state

const searchKey = () => JSON.stringify([photo.id, ...["threshold", "headroom", "max-lights"].map(name => values()[name])]);
const lensOf = name => tables.lenses.find(lens => lens.name === name);
const withLens = values => ({lens: FIRST_LENS, ...values});
const values = () => withLens(state.values);
const isStyle = ({set}) => JSON.stringify(Object.entries(withLens(set)).sort()) === JSON.stringify(Object.entries(values()).sort());

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
    showOptions();
    render();
}

function setOption(name, value, mark = name) {
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
        for (const other of ["f-number", "zoom", "focus", "ghost", "ghosts"])
            delete next[other];
    change({values: next}, mark);
    if (["lens", "strength", "exposure"].includes(name))
        options.forEach(option => option.show());
}

// Shows a sign on the picture while it is a draft.
function showSign() {
    $("sign").hidden = !photo || isLive() || hasError() || shown.full >= renderMark;
}

// Shows the state, and has it drawn.
function render() {
    renderMark++;
    changedAt = performance.now();
    if (hasError())
        report("");
    showState();
    showSign();
    if (!photo || isLive()) // which draws the next frame in this state
        return;
    clearTimeout(fullTimer);
    coarse.draw();
    full.search();
}

function showState() {
    $("undo").disabled = !past.length;
    $("redo").disabled = !future.length;
    for (const button of $("styles").children)
        button.setAttribute("aria-pressed", isStyle(tables.styles.find(style => style.name === button.dataset.name)));
    for (const button of $("lenses").children) {
        button.setAttribute("aria-checked", button.dataset.name === values().lens);
        button.tabIndex = button.dataset.name === values().lens ? 0 : -1;
    }
    showLamps();
    showPressed();
    if (photo && !isLive())
        $("command").value = commandLine(photo.file.name, values(), state.lamps, $("format").value);
}

// --------------------------------------------------------------------- lamps

const lamps = () => state.lamps || found;

function showLamps() {
    const box = $("lamps"), list = lamps();
    if (!photo)
        return;
    if (selected >= list.length)
        selected = -1;
    const doubts = state.lamps ? [] : doubtful;
    while (box.children.length > list.length + doubts.length)
        box.lastChild.remove();
    while (box.children.length < list.length + doubts.length)
        box.append(makeHandle(box.children.length));
    list.forEach((lamp, i) => place(box.children[i], lamp.x, lamp.y, `Lamp ${i + 1}, ${Math.log2(lamp.power).toFixed(1)} stops`, i));
    doubts.forEach(([x, y], i) => place(box.children[list.length + i], x, y, "Perhaps a lamp: use it", -2));
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
    const list = [...lamps(), {...LAMP, x, y}];
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
    handle.onclick = () => isLamp() ? select() : addLamp(...doubtful[i - lamps().length]);
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

// -------------------------------------------------------------------- ghosts

function showGhosts(list) {
    $("ghosts").replaceChildren(...list.map(ghost => {
        const row = document.createElement("div"), label = document.createElement("span");
        row.className = "bar";
        label.textContent = `${ghost.number}: ${(100 * ghost.share).toFixed(1)} %`;
        row.append(label, ...["solo", "mute"].map(word => {
            const button = document.createElement("button");
            button.type = "button";
            button.textContent = title(word);
            Object.assign(button.dataset, {ghost: ghost.number, word});
            button.setAttribute("aria-label", `${title(word)} ghost ${ghost.number}`);
            button.onclick = () => setGhost(ghost.number, {solo: false, mute: false, [word]: !ghostOf(ghost.number)[word]});
            return button;
        }));
        const tint = document.createElement("input");
        tint.type = "color";
        tint.title = "Tint";
        tint.dataset.ghost = ghost.number;
        tint.setAttribute("aria-label", `Tint ghost ${ghost.number}`);
        tint.oninput = () => setGhost(ghost.number, {tint: tint.value === WHITE ? null : lightOf(tint.value)}, "tint" + ghost.number);
        row.append(tint);
        const outline = () => {
            const style = $("box").style;
            for (const side of ["left", "top"])
                style[side] = 100 * ghost[side] + "%";
            style.width = 100 * (ghost.right - ghost.left) + "%";
            style.height = 100 * (ghost.bottom - ghost.top) + "%";
            $("box").hidden = false;
        };
        for (const name of ["pointerenter", "focusin"])
            row.addEventListener(name, outline);
        for (const name of ["pointerleave", "focusout"])
            row.addEventListener(name, () => $("box").hidden = true);
        return row;
    }));
    showPressed();
}

const ghostOf = number => readGhost(values().ghosts ?? "", number);

function setGhost(number, patch, mark = "") {
    setOption("ghosts", writeGhost(values().ghosts ?? "", number, {...ghostOf(number), ...patch}) || null, mark);
}

const WHITE = "#ffffff";

// Returns the light R,G,B of COLOUR, #rrggbb in sRGB.
const lightOf = colour => [1, 3, 5].map(at => parseInt(colour.slice(at, at + 2), 16) / 255)
    .map(v => Number((v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4).toFixed(4))).join();

const colourOf = light => "#" + light.split(",").map(v => Math.min(1, v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055))
    .map(v => Math.round(255 * v).toString(16).padStart(2, "0")).join("");

function showPressed() {
    for (const button of $("ghosts").querySelectorAll("button"))
        button.setAttribute("aria-pressed", Boolean(ghostOf(button.dataset.ghost)[button.dataset.word]));
    for (const tint of $("ghosts").querySelectorAll("input"))
        tint.value = colourOf(ghostOf(tint.dataset.ghost).tint ?? "1,1,1");
}

// -------------------------------------------------------------------- opening

// Returns the width and height of the picture in FILE. Its pixels are not decoded, so it may have any number.
async function measure(file) {
    const image = new Image();
    image.src = URL.createObjectURL(file);
    await new Promise((done, fail) => [image.onload, image.onerror] = [done, fail]);
    URL.revokeObjectURL(image.src);
    return [image.naturalWidth, image.naturalHeight];
}

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
        const refuse = () => {
            throw new Error(`${file.name}: the picture is damaged or of an unknown kind`);
        };
        const [width, height] = await measure(file).catch(refuse);
        if (width * height > MAX_PIXELS || Math.max(width, height) > 32768)
            throw new Error(`${file.name}: ${width} × ${height} is more than ${MAX_PIXELS / 1e6} megapixels; glint overlay has no such limit`);
        const bitmap = await createImageBitmap(file, {colorSpaceConversion: "none", premultiplyAlpha: "none"}).catch(refuse);
        show(file, bitmap, opened);
        bitmap.close();
    } catch (error) {
        report(error.message, true);
    }
}

// Makes BITMAP of FILE the photograph. First has a coarse picture drawn, whose worker finds lamps itself.
function show(file, bitmap, opened) {
    const {width, height} = bitmap;
    const pixels = size => {
        const context = new OffscreenCanvas(size.width, size.height).getContext("2d", {willReadFrequently: true});
        context.imageSmoothingQuality = "high";
        context.drawImage(bitmap, 0, 0, size.width, size.height);
        return context.getImageData(0, 0, size.width, size.height).data;
    };
    if (isLive())
        live.off();
    if (["png", "jpeg"].includes($("format").value))
        $("format").value = file.type === "image/jpeg" ? "jpeg" : "png";
    begin({file, width, height, opened});
    showCamera();
    coarse.open(pixels);
    coarse.draw();
    $("before").getContext("2d").drawImage(bitmap, 0, 0);
    full.open(pixels);
    gallery.open(pixels);
    full.search();
    showSign();
}

// Makes NEXT the photograph, without lamps.
function begin(next) {
    clearTimeout(fullTimer);
    photo = {id: (photo ? photo.id : 0) + 1, ...next};
    found = [];
    doubtful = [];
    selected = -1;
    past = [];
    future = [];
    state = {...state, lamps: null};
    renderMark++;
    changedAt = performance.now();
    delete document.body.dataset.first;
    $("empty").hidden = true;
    $("frame").hidden = false;
    [$("before").width, $("before").height] = [photo.width, photo.height];
    $("after").width = 1; // clears it
    for (const id of ["add", "find"])
        $(id).disabled = false;
    setZoom(1);
    showState();
}

// canvas.toBlob() would wait for idle time, up to 7 s after a click.
function encode(canvas, type) {
    const copy = new OffscreenCanvas(canvas.width, canvas.height);
    copy.getContext("2d").drawImage(canvas, 0, 0);
    return copy.convertToBlob({type, quality: 0.95});
}

// Saves the whole picture in the chosen format.
async function save() {
    const format = $("format").value, isDeep = format === "deep" || format === "layer", {file} = photo;
    report("Drawing the picture to save");
    if (shown.full < renderMark)
        full.draw();
    while ((shown.full < renderMark || full.busy) && !hasError())
        await new Promise(done => setTimeout(done, 50));
    if (shown.full < renderMark)
        return;
    let blob = isDeep ? await full.save(format === "layer") : await encode($("after"), "image/" + format);
    if (format === "jpeg")
        blob = await copyMetadata(file, blob);
    if (blob)
        download(blob, file.name.replace(/\.[^.]*$/, "") + (format === "jpeg" ? "-glint.jpg" : ENDINGS[format]));
}

function download(blob, name) {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(blob);
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 60000);
    report(`Saved ${name}`);
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
        button.append(document.createElement("canvas"), drawSection(lens), text);
        button.onclick = () => setOption("lens", lens.name);
        $("lenses").append(button);
        seen.observe(button);
    }
}

const seen = new IntersectionObserver(entries => {
    for (const {target, isIntersecting} of entries)
        target.dataset.seen = isIntersecting;
    gallery.next();
}, {root: $("lenses")});

// Arrow keys move from lens to lens; Tab leaves the list.
$("lenses").onkeydown = event => {
    const by = {ArrowDown: 1, ArrowRight: 1, ArrowUp: -1, ArrowLeft: -1}[event.key];
    const list = [...$("lenses").children].filter(button => !button.hidden), to = list[list.indexOf(document.activeElement) + by];
    if (!by || !to)
        return;
    to.focus();
    to.click();
    event.preventDefault();
};

// Shows the values of options, and scrolls the list of lenses to the chosen one.
function showOptions() {
    options.forEach(option => option.show());
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
            change({values: {...style.set}});
            showOptions();
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
    showOptions();
    report("Ready");
    document.body.dataset.loaded = Math.round(performance.now());
    render();
    // The address of glint web contains a random word; the name of the photograph follows '#'.
    if (/\/[0-9a-f]{32}\//.test(location.pathname) && location.hash.length > 1)
        openFrom("photo", decodeName(location.hash.slice(1)));
}

function decodeName(text) {
    try {
        return decodeURIComponent(text);
    } catch {
        return text; // not UTF-8
    }
}

// Opens a file of the server.
async function openFrom(url, name) {
    const answer = await fetch(url).catch(() => null);
    if (!answer?.ok)
        return report(name + " is missing", true);
    const blob = await answer.blob();
    open(new File([blob], name, {type: blob.type}));
}

$("file").onchange = event => open(event.target.files[0]);
$("sample").onclick = () => openFrom("sample.jpg", "sample.jpg");
$("camera").onclick = async () => isLive() ? open(await live.off()) : startCamera();
$("record").onclick = () => live.record();
$("undo").onclick = () => travel(past, future);
$("redo").onclick = () => travel(future, past);
$("export").onclick = save;
$("format").onchange = showState;
$("add").onclick = () => addLamp(photo.width / 2, photo.height / 2);
$("find").onclick = () => {
    selected = -1;
    change({lamps: null});
};
$("remove").onclick = () => removeLamp(selected);
$("power").oninput = event => changeLamp(selected, {power: 2 ** event.target.value}, "power" + selected);
$("search").oninput = showLenses;
$("ghost-box").ontoggle = () => gallery.next();
$("divider").oninput = setDivider;
$("show").onchange = event => $("lamps").className = event.target.checked ? "" : "none";
$("in").onclick = () => setZoom(zoom * 1.5);
$("out").onclick = () => setZoom(zoom / 1.5);
$("fit").onclick = () => setZoom(1);
$("copy").onclick = () => {
    $("command").select();
    navigator.clipboard ? navigator.clipboard.writeText($("command").value) : document.execCommand("copy");
};
$("apply").onclick = () => {
    try {
        change(readCommand($("command").value, tables));
        showOptions();
    } catch (error) {
        report(error.message, true);
    }
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
// glint web serves the page from this computer, at a path that is not visited again.
if (location.protocol === "https:" || location.pathname === "/")
    navigator.serviceWorker?.register("sw.js").catch(() => {});
compiled.catch(() => report("glint.wasm is missing", true));
setDivider();
coarse.worker.postMessage({kind: "tables"});
