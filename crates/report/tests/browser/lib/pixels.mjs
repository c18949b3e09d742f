// Pictures compared in the browser itself: shrunk, block by block, with a stated tolerance.

/**
 * Puts the tools into an empty page.
 *
 * `shrink` makes the picture that is kept: a WebP at `1/scale` of the size. `compare` sets blocks
 * of a new picture beside the same blocks of a kept one, wherever they stand on the page now.
 */
export async function prepare(page) {
  await page.evaluate(() => {
    const load = async (url) => createImageBitmap(await (await fetch(url)).blob());
    const canvasOf = (width, height) => new OffscreenCanvas(Math.max(1, Math.round(width)), Math.max(1, Math.round(height)));
    const urlOf = async (canvas, type) => {
      const bytes = new Uint8Array(await (await canvas.convertToBlob({ type, quality: 0.92 })).arrayBuffer());
      let text = "";
      for (let k = 0; k < bytes.length; k += 8192) text += String.fromCharCode(...bytes.subarray(k, k + 8192));
      return btoa(text);
    };
    const draw = (image, box, width, height) => {
      const canvas = canvasOf(width, height);
      const context = canvas.getContext("2d", { willReadFrequently: true });
      context.imageSmoothingQuality = "high";
      context.drawImage(image, box.x, box.y, box.width, box.height, 0, 0, canvas.width, canvas.height);
      return canvas;
    };

    // A width that is no multiple of the scale is filled up, not stretched: `compare` counts on the grid.
    window.shrink = async (url, scale) => {
      const image = await load(url);
      const [width, height] = [Math.ceil(image.width / scale), Math.ceil(image.height / scale)];
      return urlOf(draw(image, { x: 0, y: 0, width: width * scale, height: height * scale }, width, height), "image/webp");
    };

    // Both pictures of a block at the kept size, slightly blurred, so that the edge of a letter or
    // of a line may lie a fraction of a pixel elsewhere.
    const blurred = (canvas) => {
      const soft = canvasOf(canvas.width, canvas.height);
      const context = soft.getContext("2d", { willReadFrequently: true });
      context.filter = "blur(1px)";
      context.drawImage(canvas, 0, 0);
      return context.getImageData(0, 0, soft.width, soft.height).data;
    };

    window.compare = async (newUrl, keptUrl, scale, pairs, step, grain) => {
      const [now, kept] = [await load(newUrl), await load(keptUrl)];
      const shares = [];
      for (const { was, is } of pairs) {
        // Cut along pixels of the kept picture, so that both are shrunk from the same grid.
        const left = Math.floor(was.x / scale), top = Math.floor(was.y / scale);
        const width = Math.min(Math.ceil((was.x + was.width) / scale), kept.width) - left;
        const height = Math.min(Math.ceil((was.y + was.height) / scale), kept.height) - top;
        const old = draw(kept, { x: left, y: top, width, height }, width, height);
        const [wide, high] = [is.width / was.width, is.height / was.height];
        // A block may begin amid a pixel and its letters snap to the next, so a pixel up or down
        // is no difference.
        let least = 1;
        for (const shift of [0, 1, -1]) {
          const fresh = draw(now, {
            x: is.x + (left * scale - was.x) * wide, y: is.y + shift + (top * scale - was.y) * high,
            width: width * scale * wide, height: height * scale * high,
          }, width, height);
          const [a, b] = [blurred(old), blurred(fresh)];
          let changed = 0;
          for (let k = 0; k < a.length; k += 4) {
            const most = Math.max(Math.abs(a[k] - b[k]), Math.abs(a[k + 1] - b[k + 1]), Math.abs(a[k + 2] - b[k + 2]));
            if (most > 255 * step) changed += 1;
          }
          least = Math.min(least, Math.max(0, changed - grain) / (a.length / 4));
          if (least < 0.002) break;
        }
        shares.push(least);
      }
      return shares;
    };

    // The kept picture, the new one and where they differ, side by side.
    window.difference = async (newUrl, keptUrl, scale) => {
      const [now, kept] = [await load(newUrl), await load(keptUrl)];
      const width = kept.width, height = Math.max(kept.height, Math.round(now.height / scale));
      const sheet = canvasOf(3 * width + 20, height);
      const context = sheet.getContext("2d");
      context.fillStyle = "#888";
      context.fillRect(0, 0, sheet.width, sheet.height);
      context.imageSmoothingQuality = "high";
      context.drawImage(kept, 0, 0);
      context.drawImage(now, width + 10, 0, now.width / scale, now.height / scale);
      context.drawImage(kept, 2 * width + 20, 0);
      context.globalCompositeOperation = "difference";
      context.drawImage(now, 2 * width + 20, 0, now.width / scale, now.height / scale);
      return urlOf(sheet, "image/png");
    };
  });
}
