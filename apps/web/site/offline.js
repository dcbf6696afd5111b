// Keeps the page for visits without a network: all files of one version together. `cargo xtask web` writes version and files.
const VERSION = "";
const FILES = [];

const NAME = `strandline ${VERSION}`;
const fresh = (file) => new Request(file, { cache: "no-cache" });

addEventListener("install", (event) => {
  event.waitUntil(caches.open(NAME).then((kept) => kept.addAll(FILES.map(fresh))));
});

// A newer version takes over when no page of the older one is open.
addEventListener("activate", (event) => {
  const older = (name) => name.startsWith("strandline ") && name !== NAME;
  event.waitUntil(caches.keys().then((names) => Promise.all(names.filter(older).map((name) => caches.delete(name)))));
});

addEventListener("fetch", (event) => {
  if (event.request.method !== "GET") return;
  const kept = caches.open(NAME).then((files) => files.match(event.request, { ignoreSearch: true }));
  event.respondWith(kept.then((file) => file ?? fetch(event.request)));
});
