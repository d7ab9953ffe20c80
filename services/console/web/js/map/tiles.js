// Map tiles, fetched with the token: an <img> of its own accord would ask without.
import {authorization} from "../orders.js";

async function load(image, address, signal) {
  const response = await fetch(address, {headers: authorization(), signal});
  if (!response.ok) throw new Error(`the console answered ${response.status}`);
  const local = URL.createObjectURL(await response.blob());
  try {
    image.src = local;
    await image.decode();
  } finally {
    URL.revokeObjectURL(local);
  }
}

/** Like L.tileLayer(). */
export function tileLayer(template, options) {
  const Layer = L.TileLayer.extend({
    createTile(coords, done) {
      const image = document.createElement("img");
      image.alt = "";
      const abort = new AbortController();
      image.abort = () => abort.abort();
      load(image, this.getTileUrl(coords), abort.signal).then(
        () => done(null, image),
        (error) => done(error, image),
      );
      return image;
    },
  });
  const layer = new Layer(template, options);
  layer.on("tileunload", (event) => event.tile.abort());
  return layer;
}
