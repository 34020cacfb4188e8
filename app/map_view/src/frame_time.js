// The time between the frames of what moves.

// Return what says of each frame how many milliseconds it came after the one before; 0 of the first, whose time
// may even lie before the click that asked for it.
export function sinceLast() {
  let last = null;
  return (now) => {
    const gone = last === null ? 0 : now - last;
    last = now;
    return gone;
  };
}
