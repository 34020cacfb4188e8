"""What the bundles for browsers say that they were built from."""

import hashlib


def digest_of_sources(folder):
    """Return the digest as `app/bundle.mjs` writes it: of names and contents in their order."""
    named = {f"src/{path.name}": path for path in (folder / "src").iterdir()}
    shared = ("../bundle.mjs", "build.mjs", "package-lock.json")
    named |= {name: folder / name for name in shared}
    digest = hashlib.sha256()
    for name in sorted(named):
        text = named[name].read_bytes().replace(b"\r\n", b"\n")
        digest.update(f"{name} {len(text)}\n".encode() + text)
    return digest.hexdigest()
