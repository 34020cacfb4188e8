// A photo, scaled down: what a lens shows of a leaf, in a tenth of the bytes.

const LONGEST = 1600, QUALITY = 0.82;

/** The bytes and type of a picture, no side longer than 1600 pixels. */
export async function scaled(file) {
  const picture = await createImageBitmap(file, { imageOrientation: "from-image" });
  const by = Math.min(1, LONGEST / Math.max(picture.width, picture.height));
  const canvas = document.createElement("canvas");
  canvas.width = Math.max(1, Math.round(picture.width * by));
  canvas.height = Math.max(1, Math.round(picture.height * by));
  canvas.getContext("2d").drawImage(picture, 0, 0, canvas.width, canvas.height);
  picture.close();
  const blob = await new Promise((done) => canvas.toBlob(done, "image/jpeg", QUALITY));
  if (!blob) throw new Error("no picture");
  return { bytes: await blob.arrayBuffer(), type: "image/jpeg" };
}
