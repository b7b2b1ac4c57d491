// SPDX-License-Identifier: MIT
//
// sw.js - keeps copies of the page's files, which serve when the server does not answer.
const FILES = ["./", "command.js", "glint.js", "glint.wasm", "icon.svg", "jpeg.js", "page.js", "png.js", "sample.jpg", "style.css",
    "widgets.js", "worker.js"];
const urls = FILES.map(file => new URL(file, location).href);
const store = caches.open("glint");

addEventListener("install", event => event.waitUntil(store.then(cache => cache.addAll(FILES)).then(() => skipWaiting())));
addEventListener("activate", event => event.waitUntil(clients.claim()));

// URL: that of REQUEST, without a query.
async function answer(request, url) {
    const cache = await store;
    try {
        const fresh = await fetch(request);
        if (fresh.status === 200)
            cache.put(url, fresh.clone());
        return fresh;
    } catch {
        return await cache.match(url) ?? Response.error();
    }
}

addEventListener("fetch", event => {
    const {method, url} = event.request, [plain] = url.split(/[?#]/);
    if (method === "GET" && urls.includes(plain))
        event.respondWith(answer(event.request, plain));
});
