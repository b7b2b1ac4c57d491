// SPDX-License-Identifier: MIT
//
// web_page.js FOLDER - tests the web page in Debian's Chromium: drops a photograph, drags a lamp,
// chooses a lens, a style and a doubtful region. Each saved picture must equal that of the command
// that the page prints. Also: keyboard, touch, hostile files, a camera, and no server. Times are printed.
// FOLDER contains node_modules with playwright-core and axe-core (npm install playwright-core axe-core). Needs
// make web, make oiio, chromium and imagemagick. The test takes minutes, so make check does not run it.
import {execFileSync, spawn} from "node:child_process";
import fs from "node:fs";
import {createRequire} from "node:module";
import os from "node:os";
import path from "node:path";
import {randomBytes} from "node:crypto";
import {crc32, deflateSync} from "node:zlib";

const {chromium} = createRequire(path.resolve(process.argv[2]) + "/")("playwright-core");
const root = path.resolve(import.meta.dirname, "../.."), port = 8713;
const work = fs.mkdtempSync(path.join(os.tmpdir(), "web-page-"));
// Returns a video for Chromium's camera: the photograph of a lamp, with noise.
function makeVideo(w, h, frames) {
    const parts = [Buffer.from(`YUV4MPEG2 W${w} H${h} F30:1 Ip A1:1 C420jpeg\n`)];
    for (let i = 0; i < frames; i++) {
        const y = Buffer.alloc(w * h), chroma = Buffer.alloc(w * h / 2, 128);
        for (let k = 0; k < w * h; k++) {
            const d2 = (k % w - 0.3 * w) ** 2 + (Math.floor(k / w) - 0.35 * h) ** 2;
            y[k] = Math.min(255, 20 + 6 * Math.random() + 20000 / (1 + d2 / 9) ** 2);
        }
        parts.push(Buffer.from("FRAME\n"), y, chroma);
    }
    return Buffer.concat(parts);
}
fs.writeFileSync(work + "/camera.y4m", makeVideo(640, 480, 15));
const server = spawn("python3", ["-m", "http.server", "--bind", "127.0.0.1", "-d", root + "/build/web", port], {stdio: "ignore"});
const browser = await chromium.launch({executablePath: "/usr/bin/chromium", args: ["--no-sandbox", "--use-fake-device-for-media-stream",
    "--use-fake-ui-for-media-stream", "--use-file-for-fake-video-capture=" + work + "/camera.y4m"]});
const page = await browser.newPage({viewport: {width: 1280, height: 800}, acceptDownloads: true});
let failed = 0;
const check = (name, is) => {
    console.log((is ? "ok " : "not ok ") + name);
    failed += !is;
};
const wait = (is, argument = null) => page.waitForFunction(is, argument, {timeout: 0});
const show = (name, text) => console.log(`   ${name}: ${text}`);
const status = () => page.textContent("#status");
const base64 = file => fs.readFileSync(file).toString("base64");

async function drop(name, data, type) {
    await page.evaluate(([name, data, type]) => {
        delete document.body.dataset.first;
        const moved = new DataTransfer();
        moved.items.add(new File([Uint8Array.from(atob(data), c => c.charCodeAt(0))], name, {type}));
        dispatchEvent(new DragEvent("drop", {dataTransfer: moved, cancelable: true}));
    }, [name, data, type]);
}

async function open(file) {
    fs.copyFileSync(root + "/" + file, work + "/photo.jpg");
    await wait(() => document.querySelector("#sign").hidden); // Otherwise an older picture may be the first one.
    await drop("photo.jpg", base64(work + "/photo.jpg"), "image/jpeg");
    await wait(() => document.body.dataset.first);
    await page.selectOption("#format", "png");
}

// Presses Tab until the element SELECTOR has the focus.
async function tabTo(selector) {
    for (let i = 0; i < 200; i++) {
        await page.keyboard.press("Tab");
        if (await page.evaluate(one => document.activeElement.matches(one), selector))
            return;
    }
    throw new Error("Tab does not reach " + selector);
}

// Prints the milliseconds of WORK, which changes the picture, until it is shown: of three runs.
async function time(name, work) {
    const ms = [];
    for (let i = 0; i < 3; i++) {
        await page.waitForTimeout(1000);
        await page.evaluate(() => delete document.body.dataset.step);
        await work(i);
        await wait(() => document.body.dataset.step);
        ms.push(await page.evaluate(() => document.body.dataset.step));
    }
    show(name, ms.join(", ") + " ms");
}

async function printTimes() {
    await page.evaluate(async data => {
        const bitmap = await createImageBitmap(new Blob([Uint8Array.from(atob(data), c => c.charCodeAt(0))]));
        const canvas = new OffscreenCanvas(4000, 3000);
        canvas.getContext("2d").drawImage(bitmap, 0, 0, 4000, 3000);
        const moved = new DataTransfer();
        moved.items.add(new File([await canvas.convertToBlob({type: "image/jpeg", quality: 0.9})], "large.jpg", {type: "image/jpeg"}));
        dispatchEvent(new DragEvent("drop", {dataTransfer: moved, cancelable: true}));
    }, base64(root + "/tests/data/bridge.jpg"));
    await wait(() => document.body.dataset.first);
    show("first flare, 12 megapixels", await page.evaluate(() => document.body.dataset.first) + " ms");
    await time("a step of strength", i => page.fill("#option-strength", String(0.6 + 0.1 * i)).then(() => page.keyboard.press("Enter")));
    await page.locator(".lamp").first().focus();
    await time("a step of a lamp", () => page.keyboard.press("Shift+ArrowRight"));
    const {processInfo} = await (await browser.newBrowserCDPSession()).send("SystemInfo.getProcessInfo");
    const kilobytes = processInfo.map(({id}) => Number(/VmRSS:\s*(\d+)/.exec(fs.readFileSync(`/proc/${id}/status`, "utf8"))[1]));
    show("memory of the largest process", (Math.max(...kilobytes) / 1024).toFixed(0) + " MiB");
}

async function testKeyboard() {
    await page.reload();
    await wait(() => document.body.dataset.loaded);
    await tabTo("#sample");
    await page.keyboard.press("Enter");
    await wait(() => document.querySelectorAll(".lamp:not(.doubt)").length);
    await tabTo(".lamp");
    await page.keyboard.press("Delete");
    check("a key deletes a lamp", await page.evaluate(() => document.querySelector("#command").value.includes("--lights")));
    await page.keyboard.press("Control+z");
    check("Ctrl+Z restores it", !await page.evaluate(() => document.querySelector("#command").value.includes("--lights")));
    await tabTo("#divider");
    await page.keyboard.press("End");
    check("keys move the divider", await page.evaluate(() => document.querySelector("#after").style.clipPath.includes("100%")));
    await tabTo("#styles button:nth-child(2)");
    await page.keyboard.press("Enter");
    await tabTo("#lenses button");
    const before = await page.inputValue("#command");
    await page.keyboard.press("ArrowDown");
    check("keys choose a style and a lens", before.includes("--strength") && before !== await page.inputValue("#command"));
}

async function testTouch() {
    const session = await page.context().newCDPSession(page);
    await page.click("#add");
    const before = await page.inputValue("#command");
    await page.locator(".lamp").first().scrollIntoViewIfNeeded();
    const box = await page.locator(".lamp").first().boundingBox(), [x, y] = [box.x + 15, box.y + 15];
    for (const [type, points] of [["touchStart", [{x, y}]], ["touchMove", [{x: x + 30, y: y + 20}]], ["touchEnd", []]])
        await session.send("Input.dispatchTouchEvent", {type, touchPoints: points});
    await page.waitForTimeout(100);
    check("a finger drags a lamp", before !== await page.inputValue("#command"));
}

// Runs axe-core; serious findings fail.
async function testAccess(name) {
    await page.evaluate(fs.readFileSync(path.resolve(process.argv[2], "node_modules/axe-core/axe.min.js"), "utf8"));
    const {violations} = await page.evaluate(() => axe.run());
    for (const {impact, id, nodes} of violations)
        show(`axe, ${impact}`, `${id}: ${nodes[0].html}`);
    check(`axe finds nothing serious: ${name}`, !violations.some(({impact}) => impact === "serious" || impact === "critical"));
}

// Returns a small PNG file of W x H black pixels.
function makeBomb(w, h) {
    const head = Buffer.from("89504e470d0a1a0a0000000d49484452", "hex"), size = Buffer.alloc(13);
    size.writeUInt32BE(w, 0);
    size.writeUInt32BE(h, 4);
    size[8] = 1; // bit of grey a pixel
    const chunk = (type, data) => {
        const body = Buffer.concat([Buffer.from(type), data]), ends = Buffer.alloc(8);
        ends.writeUInt32BE(data.length, 0);
        ends.writeUInt32BE(crc32(body), 4);
        return Buffer.concat([ends.subarray(0, 4), body, ends.subarray(4)]);
    };
    return Buffer.concat([head.subarray(0, 8), chunk("IHDR", size), chunk("IDAT", deflateSync(Buffer.alloc((w / 8 + 1) * h))), chunk("IEND", Buffer.alloc(0))]);
}

async function testHostileFiles() {
    const photo = fs.readFileSync(work + "/photo.jpg"), jpeg = "image/jpeg";
    const gif = Buffer.from("R0lGODlhAQABAIAAAAAAAP///yH5BAEAAAAALAAAAAABAAEAAAIBRAA7", "base64");
    for (const [name, data, type] of [["cut.jpg", photo.subarray(0, 300), jpeg], ["a.svg", Buffer.from("<svg/>"), "image/svg+xml"],
        ["empty.png", Buffer.alloc(0), "image/png"], ["text.txt", Buffer.from("text"), "text/plain"], ["text.jpg", Buffer.from("text"), jpeg],
        ["bomb.png", makeBomb(20000, 20000), "image/png"], ["noise.webp", randomBytes(5000), "image/webp"]]) {
        await drop(name, data.toString("base64"), type);
        await wait(name => document.querySelector("#status.bad")?.textContent.startsWith(name), name);
        check(`${name}: ${await status()}`, name !== "bomb.png" || (await status()).includes("megapixels"));
    }
    await page.waitForTimeout(500);
    check("an error stays", (await status()).startsWith("noise.webp"));
    await page.evaluate(() => {
        const moved = new DataTransfer();
        moved.items.add(new File([new Uint8Array(201e6)], "large.png", {type: "image/png"}));
        dispatchEvent(new DragEvent("drop", {dataTransfer: moved, cancelable: true}));
    });
    await wait(() => document.querySelector("#status.bad")?.textContent.startsWith("large.png"));
    check(`large.png: ${await status()}`, true);
    for (const [name, data, type] of [["half.jpg", photo.subarray(0, photo.length / 2), jpeg],
        ["animated.gif", Buffer.concat([gif.subarray(0, 19), gif.subarray(19, -1), gif.subarray(19, -1), Buffer.from(";")]), "image/gif"]]) {
        await drop(name, data.toString("base64"), type);
        await wait(name => document.querySelector("#command").value.includes(name) && document.body.dataset.first ||
            document.querySelector("#status.bad")?.textContent.startsWith(name), name);
        check(`${name}: ${await status()}`, true);
    }
    await open("tests/gallery/window.jpg");
    check("a photograph opens after them", true);
}

async function testCamera() {
    await page.evaluate(() => {
        const media = HTMLMediaElement.prototype, {play} = media;
        media.play = function () {
            window.stream = this.srcObject;
            media.play = play;
            return Promise.reject(new Error("no play"));
        };
    });
    await page.click("#camera");
    await wait(() => document.querySelector("#status.bad")?.textContent.includes("no play"));
    check("a camera that does not play is closed", await page.evaluate(() => stream.getTracks().every(track => track.readyState === "ended")));
    await page.evaluate(() => {
        MediaRecorder.own = MediaRecorder.isTypeSupported;
        MediaRecorder.isTypeSupported = () => false;
    });
    await page.click("#camera");
    await wait(() => document.querySelector("#meter").textContent);
    check("without a type of recordings there is no Record", await page.isHidden("#record"));
    await page.evaluate(() => MediaRecorder.isTypeSupported = MediaRecorder.own);
    await page.click("#camera");
    await wait(() => document.body.dataset.first && !document.querySelector("#export").disabled);
    for (const lens of ["heliar-tronnier", "nikon-zoom-short"]) {
        await page.click(`#lenses button[data-name="${lens}"]`);
        await page.click("#camera");
        await wait(() => document.querySelector("#meter").textContent);
        await page.evaluate(() => document.querySelector("#meter").textContent = "");
        await page.waitForTimeout(3000);
        await wait(() => document.querySelector("#meter").textContent);
        show(`camera 640 x 480, one lamp, ${lens}`, await page.textContent("#meter"));
        check("the camera's picture has a flare", await page.evaluate(() => {
            const [a, b] = ["before", "after"].map(id => document.getElementById(id).getContext("2d").getImageData(0, 0, 640, 480).data);
            return a.some((value, i) => b[i] > value + 20);
        }));
        if (lens === "heliar-tronnier") {
            await page.click("#record");
            await page.waitForTimeout(2000);
            const [download] = await Promise.all([page.waitForEvent("download"), page.click("#record")]);
            const video = fs.readFileSync(await download.path());
            check(`a recording is a WebM file of ${video.length} bytes`, video.length > 1500 && video.readUInt32BE(0) === 0x1a45dfa3);
        }
        await page.click("#camera");
        await wait(() => document.body.dataset.first && !document.querySelector("#export").disabled);
        check("its last frame becomes the photograph", (await page.inputValue("#command")).includes("camera.png"));
    }
}

async function testOffline() {
    check("there is a service worker", await page.evaluate(async () =>
        Boolean(await navigator.serviceWorker.getRegistration() && await navigator.serviceWorker.ready)));
    check("it keeps only the page's files", await page.evaluate(async () => {
        await Promise.all(["sw.js", "index.html", "glint.js?1"].map(file => fetch(file).then(answer => answer.text())));
        const kept = await (await caches.open("glint")).keys();
        return kept.length === 12 && !kept.some(({url}) => /sw.js|index|\?/.test(url));
    }));
    server.kill();
    await new Promise(done => server.once("exit", done));
    await page.reload();
    await wait(() => document.body.dataset.loaded);
    await page.click("#sample");
    await wait(() => document.body.dataset.first);
    check("the page works without its server", true);
}

// Returns the samples that the browser decodes from a file.
const decode = file => page.evaluate(async data => {
    const blob = new Blob([Uint8Array.from(atob(data), c => c.charCodeAt(0))]);
    const bitmap = await createImageBitmap(blob, {colorSpaceConversion: "none"});
    const context = new OffscreenCanvas(bitmap.width, bitmap.height).getContext("2d");
    context.drawImage(bitmap, 0, 0);
    return Array.from(context.getImageData(0, 0, bitmap.width, bitmap.height).data).join();
}, base64(file));

// Saves the picture, runs the printed command, and compares.
async function compare(name) {
    const command = await page.inputValue("#command"), output = work + "/" + / -o (\S+)/.exec(command.split("\n").at(-2))[1];
    const isDeep = await page.inputValue("#format") !== "png";
    const [download] = await Promise.all([page.waitForEvent("download", {timeout: 0}), page.click("#export")]);
    await download.saveAs(work + "/page.png");
    execFileSync("bash", ["-ec", command], {cwd: work, stdio: "ignore", env: {...process.env, PATH: root + "/build:" + process.env.PATH,
        GLINT_LENSES: root + "/lenses", GLINT_OIIO: root + "/build/glint-oiio.so"}});
    if (!isDeep)
        return check(name, await decode(work + "/page.png") === await decode(output));
    // By ImageMagick. Few samples may differ by few codes, see web_bits.js.
    const [a, b] = [work + "/page.png", output].map(file => execFileSync("convert", [file, "-depth", "16", "-endian", "MSB", "rgba:-"], {maxBuffer: 1e9}));
    let differ = 0, deep = 0;
    for (let i = 0; i < a.length; i += 2) {
        const by = Math.abs(a.readUInt16BE(i) - b.readUInt16BE(i));
        differ += by > 16 ? Infinity : by > 0;
        deep += a[i] !== a[i + 1];
    }
    check(`${name}: ${differ} of ${a.length / 2} samples differ`, a.length === b.length && 500 * differ < a.length / 2);
    check("it has more than 8 bits", deep > a.length / 100);
}

try {
    const outside = [], errors = [];
    page.on("pageerror", error => errors.push(error.message));
    page.on("request", request => /^(http:\/\/127\.0\.0\.1|blob:|data:)/.test(request.url()) || outside.push(request.url()));
    for (let i = 0; i < 100 && await page.goto(`http://127.0.0.1:${port}/`).then(() => false, () => true); i++)
        await new Promise(done => setTimeout(done, 100));
    await wait(() => document.body.dataset.loaded);
    show("first paint", await page.evaluate(() => performance.getEntriesByName("first-contentful-paint")[0]?.startTime.toFixed(0)) + " ms, ready after " +
        await page.evaluate(() => document.body.dataset.loaded) + " ms");
    await printTimes();
    check("a JPEG photograph is saved as JPEG unless another format is chosen", await page.inputValue("#format") === "jpeg");
    check("the style of the defaults is marked", await page.getAttribute('#styles button[data-name="natural"]', "aria-pressed") === "false" &&
        await page.click("#undo").then(() => page.click("#undo")).then(() => page.getAttribute('#styles button[data-name="natural"]', "aria-pressed")) === "true");
    await page.evaluate(() => {
        const sign = document.querySelector("#sign");
        new MutationObserver(() => sign.hidden || (document.body.dataset.drafted = 1)).observe(sign, {attributes: true});
    });
    await open("tests/data/bridge.jpg");
    await wait(() => document.querySelector("#sign").hidden);
    check("a sign tells a draft", await page.evaluate(() => document.body.dataset.drafted));
    check("it ends with the whole picture", (await status()).includes("drawn in"));
    await compare("lamps as they are found");
    show("memory of the module that drew this", (await page.evaluate(() => document.body.dataset.memory) / 2 ** 20).toFixed(0) + " MiB");

    const box = await page.locator(".lamp").first().boundingBox();
    await page.mouse.move(box.x + 15, box.y + 15);
    await page.mouse.down();
    await page.mouse.move(box.x + 90, box.y + 50, {steps: 5});
    await page.mouse.up();
    await page.locator(".lamp").first().focus();
    await page.keyboard.press("ArrowRight");
    await page.keyboard.press("+");
    await compare("a lamp that was dragged and moved by keys");
    await page.fill("#search", "westanar");
    await page.click('#lenses button[data-name="tele-westanar-135"]');
    await compare("another lens");
    await page.focus("#search");
    await page.fill("#search", "");
    await page.keyboard.press("Tab");
    await page.keyboard.press("ArrowUp");
    check("arrow keys choose lenses", await page.evaluate(() => document.activeElement.getAttribute("aria-checked") === "true" &&
        document.activeElement.dataset.name !== "tele-westanar-135"));
    await wait(() => document.activeElement.dataset.thumb);
    check("the list shows the photograph with each lens", true);
    await page.click('#styles button[data-name="toy"]');
    await compare("a style");
    await page.click("#undo");
    check("undo shows the lens that it restores", await page.evaluate(() => {
        const [list, lens] = ["#lenses", "#lenses [aria-checked=true]"].map(one => document.querySelector(one).getBoundingClientRect());
        return lens.top >= list.top - 1 && lens.bottom <= list.bottom + 1;
    }));
    await page.click("#redo");
    await page.click("#ghost-box summary");
    await page.click('#ghosts button[aria-label^="Mute"]', {timeout: 0});
    await page.locator('#ghosts input[type="color"]').nth(1).fill("#ff8000");
    await compare("a ghost left out, and one tinted");
    check("the command tints it", / tint 1,0.2159,0\n/.test(await page.inputValue("#command")));
    await page.locator("#ghosts button[data-word=solo]").nth(1).click();
    await compare("a tinted ghost alone");
    await page.selectOption("#format", "deep");
    await compare("a picture of 16 bits");
    await page.selectOption("#format", "layer");
    await compare("the flare alone, with alpha");
    await page.selectOption("#format", "jpeg");
    const [download] = await Promise.all([page.waitForEvent("download", {timeout: 0}), page.click("#export")]);
    await page.selectOption("#format", "png");
    const saved = fs.readFileSync(await download.path()).toString("latin1");
    check("a JPEG file keeps the metadata of the photograph", saved.includes("Exif\0\0") && saved.includes("OLYMPUS"));
    await open("tests/gallery/window.jpg");
    await wait(() => document.querySelectorAll(".doubt").length === 3);
    await page.locator(".doubt").first().click();
    await compare("a doubtful region as a lamp");
    const text = await page.inputValue("#command");
    await page.click('#styles button[data-name="vintage"]');
    await page.click("#command-box summary");
    await page.fill("#command", text);
    await page.click("#apply");
    check("a command sets the page", text === await page.inputValue("#command"));
    await page.fill("#command", "glint overlay x.jpg --nonsense 3");
    await page.click("#apply");
    check(`another one does not: ${await status()}`, (await status()).includes("--nonsense"));
    await page.evaluate(() => document.querySelectorAll("details").forEach(one => one.open = true));
    await testAccess("1280 pixels wide");
    await page.setViewportSize({width: 360, height: 740});
    check("360 pixels are wide enough", await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
    await testAccess("360 pixels wide");
    await page.emulateMedia({reducedMotion: "reduce"});
    check("nothing moves with reduced motion", await page.evaluate(() => [...document.querySelectorAll("*")]
        .every(one => getComputedStyle(one).transitionDuration === "0s" && getComputedStyle(one).animationName === "none")));
    await testTouch();
    await page.setViewportSize({width: 1280, height: 800});
    await testHostileFiles();
    await testCamera();
    await testKeyboard();
    await testOffline();
    check("the page had no errors: " + errors.join(), errors.length === 0);
    check("no request leaves the computer", outside.length === 0);
} finally {
    await browser.close();
    server.kill();
    fs.rmSync(work, {recursive: true});
}
process.exitCode = failed ? 1 : 0;
