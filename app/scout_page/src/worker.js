// Hands out the page without a network. It never touches what belongs to a season.

// filled in by the server: they change with any of the files
const VERSION = "@VERSION@", FILES = "@FILES@".split(" ");

self.addEventListener("install", (event) => {
  event.waitUntil((async () => {
    const cache = await caches.open(VERSION);
    await cache.addAll(FILES.map((file) => new Request(file, { cache: "reload" })));
    await self.skipWaiting();
  })());
});

self.addEventListener("activate", (event) => {
  event.waitUntil((async () => {
    for (const name of await caches.keys()) if (name !== VERSION) await caches.delete(name);
    await self.clients.claim();
  })());
});

self.addEventListener("fetch", (event) => {
  const address = new URL(event.request.url);
  if (event.request.method !== "GET" || address.origin !== location.origin || !address.pathname.startsWith("/scouting/")) return;
  event.respondWith((async () => {
    const cache = await caches.open(VERSION);
    const kept = event.request.mode === "navigate" ? await cache.match("./") : await cache.match(event.request, { ignoreSearch: true });
    return kept ?? fetch(event.request);
  })());
});
