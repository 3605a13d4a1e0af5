/* Images of the API in img and SVG image elements. Where the engine is in the browser, the bytes of an image are kept
 * until the element shows another one, or is found to be gone.
 * exports: showImage(lab, node, path)   null: no image. The same path again changes nothing; late replies are dropped.
 *                                       The element's data-path is the path */

const kept = new Map(); /* node -> address */

function release(engine, node) {
  if (kept.has(node)) engine.release(kept.get(node));
  kept.delete(node);
}

export async function showImage({ engine }, node, path) {
  if ((node.dataset.path ?? null) === path) return;
  const attribute = node instanceof SVGElement ? 'href' : 'src';
  for (const each of [...kept.keys()]) if (!each.isConnected && each.complete) release(engine, each);
  if (!path) {
    delete node.dataset.path;
    node.removeAttribute(attribute);
    release(engine, node);
    return;
  }
  node.dataset.path = path;
  const address = await engine.address(path).catch(() => null);
  if (node.dataset.path !== path) {
    if (address) engine.release(address);
    return;
  }
  release(engine, node);
  if (!address) {
    delete node.dataset.path; /* it may be fetched again */
    node.removeAttribute(attribute);
    return;
  }
  node.setAttribute(attribute, address);
  kept.set(node, address);
}
