// SPDX-License-Identifier: MIT
//
// widgets.js - controls made from the table of options, and drawings of lenses.

// Options shown first, and those not shown.
const MAIN = ["strength", "f-number", "stop", "starburst", "coating", "veil", "haze", "dust", "front-dust"];
const HIDDEN = ["lens", "memory", "half", "ghosts"];
const GROUPS = ["lamps", "lens", "brightness", "speed"];
const COATINGS = ["mixed", "table", "none", "v-coat", "broadband-3", "broadband-4"];
const STEPS = 1000; // of a slider

export const title = name => name[0].toUpperCase() + name.slice(1).replaceAll("-", " ");

function element(name, attributes = {}, ...children) {
    const made = document.createElement(name);
    for (const [key, value] of Object.entries(attributes))
        made.setAttribute(key, value);
    made.append(...children);
    return made;
}

// Returns the exponent of a slider from LOW to HIGH: a default above LOW lies in its middle.
function bend(low, high, initial) {
    return initial > low && initial < high ? Math.log((initial - low) / (high - low)) / Math.log(0.5) : 3;
}

const short = value => String(Number(Number(value).toPrecision(4)));

// A slider and a field for the number ROW.
function makeNumber(row, host, id) {
    const slider = element("input", {type: "range", min: 0, max: STEPS, step: 1, "aria-label": title(row.name) + ", slider"});
    const field = element("input", {type: "number", id, step: "any"});
    const range = () => {
        const lens = host.lens();
        let {low, high, initial} = row;
        if (row.name === "f-number")
            [low, high, initial] = [Number((1.0005 * lens.widest).toPrecision(4)), 64, lens.f]; // rounded up
        if (row.name === "zoom")
            [low, high, initial] = [0, 1, 0];
        if (row.name === "focus")
            [low, high, initial] = [0.3, 100, 100];
        if (high === null || high > 1e6)
            high = 100 * (initial || 1);
        return {low, high, initial: initial ?? low, power: bend(low, high, initial ?? low)};
    };
    const widget = element("span", {class: "pair"}, slider, field);
    slider.oninput = () => {
        const {low, high, power} = range();
        let value = low + (high - low) * (slider.value / STEPS) ** power;
        if (row.type === "integer")
            value = Math.round(value);
        host.set(row.name, short(value));
        field.value = short(value);
    };
    field.onchange = () => {
        host.set(row.name, field.value === "" ? null : field.value);
        show();
    };
    function show() {
        const {low, high, initial, power} = range(), given = host.value(row.name);
        const value = given === "off" ? 0 : Number(given ?? initial);
        field.value = given ?? (row.initial === null && row.name !== "f-number" ? "" : short(initial));
        slider.value = STEPS * Math.min(1, Math.max(0, (value - low) / (high - low))) ** (1 / power);
    }
    return {widget, show};
}

function makeChoice(row, host, id, words) {
    const widget = element("select", {id}, ...words.map(word => element("option", {value: word}, word)));
    const initial = row.type === "word" ? words[row.initial ?? 0] : words[0];
    widget.onchange = () => host.set(row.name, widget.value === initial ? null : widget.value);
    const show = () => {
        const value = host.value(row.name) ?? initial;
        if (![...widget.options].some(option => option.value === value))
            widget.append(element("option", {value}, value));
        widget.value = value;
    };
    return {widget, show};
}

function makeFlag(row, host, id) {
    const widget = element("input", {type: "checkbox", id});
    widget.onchange = () => host.set(row.name, widget.checked ? "yes" : null);
    return {widget, show: () => widget.checked = host.value(row.name) === "yes"};
}

function makeText(row, host, id) {
    const widget = element("input", {id, placeholder: row.text || row.value});
    widget.onchange = () => host.set(row.name, widget.value.trim() || null);
    return {widget, show: () => widget.value = host.value(row.name) ?? ""};
}

// The stop: blades, roundness, softness and rotation, as one text of the option.
function makeStop(row, host, id) {
    const range = (label, max, step, first) => {
        const input = element("input", {type: "range", min: 0, max, step, ...first ? {id: first} : {}, "aria-label": label});
        const out = element("output");
        input.oninput = store;
        return {input, out, line: element("span", {class: "pair"}, element("span", {}, label), input, out)};
    };
    const blades = range("Blades, 0 a circle", 16, 1, id), round = range("Roundness", 1, 0.05), soft = range("Softness", 1, 0.05),
        turn = range("Rotation", 90, 1);
    const all = [blades, round, soft, turn];
    const print = () => all.forEach(({input, out}) => out.textContent = input.value);
    function store() {
        const n = Number(blades.input.value);
        const shape = n < 3 ? "circle" : `polygon:${n}` + (Number(turn.input.value) ? "," + turn.input.value : "");
        host.set("stop", shape + (n >= 3 && Number(round.input.value) ? ",round:" + round.input.value : "") +
            (Number(soft.input.value) ? ",soft:" + soft.input.value : ""));
        print();
    }
    function show() {
        const text = host.value("stop") ?? "polygon:8,round:0.2";
        const number = pattern => Number((pattern.exec(text) ?? [0, 0])[1]);
        blades.input.value = number(/polygon:(\d+)/);
        turn.input.value = number(/polygon:\d+,([\d.]+)/);
        round.input.value = number(/round:([\d.]+)/);
        soft.input.value = number(/soft:([\d.]+)/);
        print();
    }
    return {widget: element("div", {}, ...all.map(({line}) => line)), show};
}

// A fraction with an optional seed.
function makeDust(row, host, id) {
    const {widget, show} = makeNumber({...row, type: "real", low: 0, high: 0.5, initial: 0},
        {...host, value: name => host.value(name)?.split(",")[0], set: (name, value) => host.set(name, Number(value) ? value : null)}, id);
    return {widget, show};
}

function makeWidget(row, host, id) {
    if (row.name === "stop")
        return makeStop(row, host, id);
    if (row.name === "coating")
        return makeChoice(row, host, id, COATINGS);
    if (row.name === "dust" || row.name === "front-dust")
        return makeDust(row, host, id);
    if (row.type === "real" || row.type === "integer")
        return makeNumber(row, host, id);
    if (row.type === "word")
        return makeChoice(row, host, id, row.accepts.split("|"));
    return row.type === "flag" ? makeFlag(row, host, id) : makeText(row, host, id);
}

// Fills MAIN_BOX and MORE_BOX with controls of the table ROWS; returns them. HOST has value(name),
// set(name, text or null) and lens().
export function makeOptions(rows, mainBox, moreBox, host) {
    const made = [];
    const add = (row, box) => {
        const id = "option-" + row.name;
        const {widget, show} = makeWidget(row, host, id);
        const unit = row.type === "real" || row.type === "integer" ? row.accepts : "";
        const label = element("label", {for: id}, title(row.name) + (unit && !/^(a|or) /.test(unit) ? `, ${unit}` : ""));
        label.title = row.help;
        box.append(element("div", {class: "option", title: row.help}, label, widget));
        show();
        made.push({show});
    };
    for (const name of MAIN)
        add(rows.find(row => row.name === name), mainBox);
    for (const row of rows)
        if (GROUPS.includes(row.group) && !MAIN.includes(row.name) && !HIDDEN.includes(row.name))
            add(row, moreBox);
    return made;
}

// ----------------------------------------------------------------- drawings

const SVG = "http://www.w3.org/2000/svg";

// Returns points of the profile of a sphere of RADIUS at Z, up to the height SEMI.
function profile(z, radius, semi) {
    const points = [];
    for (let k = -8; k <= 8; k++) {
        const h = semi * k / 8, r2 = radius * radius;
        const sag = radius && h * h < r2 ? radius - Math.sign(radius) * Math.sqrt(r2 - h * h) : 0;
        points.push([z + sag, h]);
    }
    return points;
}

// Returns a drawing of the section of LENS; aspheres are drawn as spheres.
export function drawSection(lens) {
    const svg = document.createElementNS(SVG, "svg");
    let z = 0, path = "", last = 0, highest = 1, stop = 0;
    lens.surfaces.forEach(([radius, thickness, semi, index], i) => {
        const next = lens.surfaces[i + 1];
        if (index > 1.01 && next) {
            const rim = Math.max(semi, next[2]);
            const line = [...profile(z, radius, rim), ...profile(z + thickness, next[0], rim).reverse()];
            path += "M" + line.map(([x, y]) => `${x.toFixed(2)} ${y.toFixed(2)}`).join("L") + "Z";
        }
        highest = Math.max(highest, semi);
        last = z;
        if (i + 1 === lens.stopAfter) {
            z += thickness;
            stop = z;
            z += lens.stopThickness;
        } else
            z += thickness;
    });
    const pad = 0.1 * Math.max(last, highest);
    svg.setAttribute("viewBox", `${-pad} ${-highest - pad} ${last + 2 * pad} ${2 * (highest + pad)}`);
    svg.setAttribute("aria-hidden", "true");
    const glass = document.createElementNS(SVG, "path"), blades = document.createElementNS(SVG, "path");
    glass.setAttribute("d", path);
    glass.setAttribute("fill", "#7fb4e8");
    glass.setAttribute("fill-opacity", "0.45");
    glass.setAttribute("stroke", "#c8ddf5");
    blades.setAttribute("d", `M${stop} ${-highest}V${-lens.stopSemi}M${stop} ${highest}V${lens.stopSemi}`);
    blades.setAttribute("stroke", "#ffd166");
    for (const line of [glass, blades])
        line.setAttribute("vector-effect", "non-scaling-stroke");
    svg.append(glass, blades);
    return svg;
}
