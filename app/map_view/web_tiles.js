// A worker that asks one server for pictures: the one that its own policy names (see app/startup/serve.py).
// The page around it may ask none.

const asked = new Map();

onmessage = async ({ data: { k, url } }) => {
  if (!url) {
    asked.get(k)?.abort(); // nobody looks there any more
    return;
  }
  const stop = new AbortController();
  asked.set(k, stop);
  try {
    const answer = await fetch(url, { signal: stop.signal });
    postMessage({ k, status: answer.status, blob: await answer.blob() });
  } catch {
    postMessage({ k, status: 0 });
  } finally {
    asked.delete(k);
  }
};
