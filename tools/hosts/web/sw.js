// SPDX-License-Identifier: MIT
//
// sw.js - keeps copies of the page's files, which serve when the server does not answer.
const FILES = ["./", "command.js", "glint.js", "glint.wasm", "icon.svg", "jpeg.js", "page.js", "sample.jpg", "style.css", "widgets.js",
    "worker.js"];
const store = caches.open("glint");

addEventListener("install", event => event.waitUntil(store.then(cache => cache.addAll(FILES)).then(() => skipWaiting())));
addEventListener("activate", event => event.waitUntil(clients.claim()));

async function answer(request) {
    const cache = await store;
    try {
        const fresh = await fetch(request);
        if (fresh.ok)
            cache.put(request, fresh.clone());
        return fresh;
    } catch {
        return await cache.match(request, {ignoreSearch: true}) ?? Response.error();
    }
}

addEventListener("fetch", event => {
    const {method, url} = event.request;
    if (method === "GET" && url.startsWith(registration.scope))
        event.respondWith(answer(event.request));
});
