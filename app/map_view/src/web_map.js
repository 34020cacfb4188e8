// Pictures from a server that was agreed to, asked for by the worker that may ask it: see ../web_tiles.js.

const askers = new Map();

// Return what fetches from that server, by the address of its worker: {url, signal} becomes {status, blob}.
export function askerAt(address) {
  if (!askers.has(address)) askers.set(address, asker(address));
  return askers.get(address);
}

function asker(address) {
  const waiting = new Map();
  let worker = null, n = 0;

  function begin() {
    worker = new Worker(address);
    worker.onmessage = ({ data: { k, ...answer } }) => {
      waiting.get(k)?.(answer);
      waiting.delete(k);
    };
    worker.onerror = () => {
      worker = null; // the next picture begins another
      for (const done of waiting.values()) done({ status: 0 });
      waiting.clear();
    };
  }

  return ({ url, signal }) => new Promise((done) => {
    if (!worker) begin();
    const k = n++;
    waiting.set(k, done);
    signal?.addEventListener("abort", () => worker?.postMessage({ k }));
    worker.postMessage({ k, url });
  });
}
