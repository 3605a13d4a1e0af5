/* A laboratory in the browser ends with its page: the unsaved scene of the tab is kept as the code of a link, and the
 * next page of the tab offers it (rescue.js). A scene that reads files has no such code and is not kept.
 * exports: keepUnsaved(lab) -> {offer() -> null or {id, time, title, file}, open(), drop()} */

const KEY = 'cuvette.unsaved';
const REST_MS = 1000; /* kept when the scene rests */

/* Storage may be forbidden or full: then nothing is kept. */
function stored(act) {
  try {
    return act(sessionStorage);
  } catch {
    return null;
  }
}

export function keepUnsaved(lab) {
  let found = null; /* of the page before */
  let timer = 0;
  if (lab.engine.kind === 'browser') {
    found = stored((storage) => JSON.parse(storage.getItem(KEY)));
    lab.on('state', () => {
      clearTimeout(timer);
      timer = setTimeout(keep, REST_MS);
    });
  }
  return {
    offer: () => found && { id: KEY, ...found },
    async open() {
      await lab.change('/api/open', { link: `#scene=${found.code}` });
      lab.panels.reveal();
      found = null;
    },
    drop() {
      found = null;
      stored((storage) => storage.removeItem(KEY));
    },
  };

  async function keep() {
    const { saved, unsaved, undo, title, file } = lab.state;
    if (saved && undo) stored((storage) => storage.removeItem(KEY));
    if (!unsaved) return;
    const { code } = await lab.get('/api/link').catch(() => ({}));
    if (code) stored((storage) => storage.setItem(KEY, JSON.stringify({ code, time: Date.now(), title, file })));
  }
}
