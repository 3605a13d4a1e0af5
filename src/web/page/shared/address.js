/* What the page's address names, and what the tab remembers. While a shared scene or a lesson is shown, the address
 * names it (#scene=CODE, #lesson=NAME), so that a bookmark or a copied address opens it again. A reload, Back and
 * Forward show what was shown, with its changes.
 * exports:
 *   named() -> {scene: the fragment or '', lesson: NAME or ''}
 *   name(fragment)      the address names that from now on; '': nothing
 *   returned()          whether this page was shown before in this tab: by a reload, Back or Forward
 *   session.get(key), session.set(key, value), session.drop(key)     of this tab, as long as it is open; storage may be
 *                       forbidden or full: then nothing is remembered */

const stored = (act) => {
  try {
    return act(sessionStorage);
  } catch {
    return null;
  }
};

export const session = {
  get: (key) => stored((storage) => JSON.parse(storage.getItem(`cuvette.${key}`))),
  set: (key, value) => stored((storage) => storage.setItem(`cuvette.${key}`, JSON.stringify(value))),
  drop: (key) => stored((storage) => storage.removeItem(`cuvette.${key}`)),
};

export function named() {
  const fragment = location.hash;
  return {
    scene: fragment.startsWith('#scene=') ? fragment : '',
    lesson: /^#lesson=([\w-]+)$/.exec(fragment)?.[1] ?? '',
  };
}

/* A fragment of another kind, such as the place in a notebook, stays. */
export function name(fragment) {
  const { scene, lesson } = named();
  if (location.protocol === 'about:' || (!fragment && !scene && !lesson)) return;
  history.replaceState(null, '', `${location.pathname}${location.search}${fragment}`);
}

const FRESH = 'navigate';
export const returned = () => (performance.getEntriesByType('navigation')[0]?.type ?? FRESH) !== FRESH;
