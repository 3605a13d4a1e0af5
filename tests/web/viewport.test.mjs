// Views: the pivot stays, the distance is bounded, two fingers zoom and pan, views have a history apart from undo, and
// all of it by keyboard.

const PIVOT = [0, 1.5, 0]; // of rod.yaml

async function change(screen, act) {
  const { generation } = await screen.lab.get('/api/state');
  await act();
  await screen.until((g) => window.lab.newestGeneration > g, generation);
  await screen.quiet();
  const state = await screen.lab.get('/api/state');
  await screen.until((g) => window.lab.state.generation >= g, state.generation); // the next gesture starts from it
  return state;
}

/** The middle of the image in the window. */
async function middleOf(screen) {
  const { width, height } = await screen.page.evaluate(() => window.lab.view);
  return screen.place(width / 2, height / 2);
}

const far = (a, b) => Math.hypot(...a.map((x, i) => x - b[i]));

/** Fingers on the image, as the browser reports them: [[x, y], ..] per step; the last step lifts all. */
async function touch(screen, steps) {
  const session = await screen.context.newCDPSession(screen.page);
  const send = (type, points) =>
    session.send('Input.dispatchTouchEvent', {
      type,
      touchPoints: points.map(([x, y], id) => ({ x, y, id })),
    });
  await send('touchStart', steps[0].slice(0, 1));
  await send('touchStart', steps[0]);
  for (const step of steps.slice(1)) await send('touchMove', step);
  await send('touchEnd', []);
  await session.detach();
}

export const cases = {
  'the drawing of the axes turns with the camera': async (t) => {
    const screen = await t.open(await t.lab('scenes/rod.yaml'));
    const tips = () =>
      screen.page.evaluate(() =>
        Object.fromEntries(
          ['x', 'y', 'z'].map((name) => {
            const tip = document.querySelector(`.view-axes .axis-${name} circle`);
            const at = ['cx', 'cy'].map((k) => Math.sign(Math.round(Number(tip.getAttribute(k)))));
            return [name, [...at, tip.getAttribute('class')]];
          }),
        ),
      );
    const sides = {
      // right and down are positive
      z: { x: [1, 0, 'far'], y: [0, -1, 'far'], z: [0, 0, 'far'] },
      'Shift+Z': { x: [-1, 0, 'far'], y: [0, -1, 'far'], z: [0, 0, 'near'] },
      x: { x: [0, 0, 'near'], y: [0, -1, 'far'], z: [1, 0, 'far'] },
      y: { x: [1, 0, 'far'], y: [0, 0, 'near'], z: [0, -1, 'far'] },
    };
    for (const [key, expected] of Object.entries(sides)) {
      await change(screen, async () => {
        await screen.page.locator('#image').focus();
        await screen.page.keyboard.press(key);
      });
      t.equal(await tips(), expected, `the axes after ${key}`);
    }
  },

  'fifty notches and twenty orbits leave the pivot where it is': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    const at = await middleOf(screen);
    await screen.page.mouse.move(at.x, at.y);
    let state = await lab.get('/api/state');
    let nearest = Infinity;
    for (let k = 0; k < 20; k++) {
      state = await change(screen, async () => {
        for (let n = 0; n < 5; n++) await screen.page.mouse.wheel(0, k < 10 ? -100 : 100);
        await screen.page.mouse.down();
        await screen.page.mouse.move(at.x + (k % 2 ? 90 : -70), at.y + (k % 3) * 40 - 40, { steps: 3 });
        await screen.page.mouse.up();
        await screen.page.mouse.move(at.x, at.y);
      });
      t.equal(state.camera.target, PIVOT, `the target after ${5 * (k + 1)} notches and ${k + 1} orbits`);
      t.more(state.camera.eye[1], 0, 'the height of the camera above the ground');
      nearest = Math.min(nearest, state.camera.distance);
    }
    t.check(nearest < 0.5, `50 notches go near the pivot, to ${nearest}`);
    t.check(state.saved, 'the scene counts as saved after moves of the camera');
    t.equal(state.undo, null, 'moves of the camera are nothing to undo');
    await change(screen, async () => {
      for (let n = 0; n < 100; n++) await screen.page.mouse.wheel(0, -100);
    });
    const near = (await lab.get('/api/state')).camera;
    t.equal(near.target, PIVOT, 'the target at the nearest distance');
    t.more(near.distance, 1e-3, 'the nearest distance');
    await change(screen, async () => {
      for (let n = 0; n < 200; n++) await screen.page.mouse.wheel(0, 100);
    });
    const { camera } = await lab.get('/api/state');
    t.check(camera.distance < 100, `the farthest distance is ${camera.distance}`);
    t.more(camera.eye[1], 0, 'the height of the camera at the farthest distance');
  },

  'an orbit from below stops at the ground': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    const at = await middleOf(screen);
    const { camera } = await change(screen, async () => {
      await screen.page.mouse.move(at.x, at.y);
      await screen.page.mouse.down();
      await screen.page.mouse.move(at.x, at.y - 200, { steps: 8 });
      await screen.page.mouse.up();
    });
    t.more(camera.eye[1], 0, 'the height of the camera');
    t.check(camera.eye[1] < 0.1, `the camera is just above the ground: ${camera.eye[1]}`);
    t.equal(camera.target, PIVOT, 'the target');
  },

  'Shift and the middle button pan': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    const at = await middleOf(screen);
    const drag = async (button) => {
      await screen.page.mouse.move(at.x, at.y);
      await screen.page.mouse.down({ button });
      await screen.page.mouse.move(at.x + 60, at.y, { steps: 4 });
      await screen.page.mouse.up({ button });
    };
    for (const how of ['Shift', 'middle']) {
      const before = await screen.page.evaluate((p) => window.lab.view.project(p), PIVOT);
      if (how === 'Shift') await screen.page.keyboard.down('Shift');
      const state = await change(screen, () => drag(how === 'middle' ? 'middle' : 'left'));
      await screen.page.keyboard.up('Shift');
      await screen.until((g) => window.lab.state.generation >= g, state.generation);
      const after = await screen.page.evaluate((p) => window.lab.view.project(p), PIVOT);
      const scale = await screen.page.evaluate(() => window.lab.view.scale);
      t.near((after.x - before.x) * scale, 60, 1.5, `${how}: the image follows the pointer, CSS pixels`);
      t.near(far(state.camera.eye, state.camera.target), far([0, 2.75, -6], PIVOT), 1e-9, `${how}: the distance stays`);
    }
  },

  'a pinch scales the distance, and two fingers pan': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    const { x, y } = await middleOf(screen);
    const first = (await lab.get('/api/state')).camera;
    const spread = (half) => [
      [x - half, y],
      [x + half, y],
    ];
    let state = await change(screen, () => touch(screen, [40, 50, 60, 70, 80].map(spread)));
    t.near(state.camera.distance, first.distance / 2, 1e-6, 'fingers twice as far apart halve the distance');
    t.near(far(state.camera.target, PIVOT), 0, 1e-12, 'the target stays');
    state = await change(screen, () => touch(screen, [80, 60, 40].map(spread)));
    t.near(state.camera.distance, first.distance, 1e-6, 'and back');
    const before = await screen.page.evaluate((p) => window.lab.view.project(p), PIVOT);
    const shifted = (dx) => spread(60).map(([px, py]) => [px + dx, py]);
    state = await change(screen, () => touch(screen, [0, 15, 30, 50].map(shifted)));
    await screen.until((g) => window.lab.state.generation >= g, state.generation);
    const after = await screen.page.evaluate((p) => window.lab.view.project(p), PIVOT);
    const scale = await screen.page.evaluate(() => window.lab.view.scale);
    t.near((after.x - before.x) * scale, 50, 1.5, 'two fingers move the image, CSS pixels');
    t.near(state.camera.distance, first.distance, 1e-6, 'at the same distance');
    t.near(far(state.camera.forward, first.forward), 0, 1e-9, 'without a rotation');
    for (let k = 0; k < 3; k++) await change(screen, () => screen.page.keyboard.press('b'));
    t.near(far((await lab.get('/api/state')).camera.eye, first.eye), 0, 1e-12, 'three gestures are three views');
  },

  'views by keyboard': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    await screen.stage.focus();
    const press = (key) => change(screen, () => screen.page.keyboard.press(key));
    for (const [key, forward] of [
      ['z', [0, 0, 1]],
      ['x', [-1, 0, 0]],
      ['y', [0, -1, 0]],
      ['Shift+Z', [0, 0, -1]],
      ['Shift+X', [1, 0, 0]],
    ]) {
      const { camera } = await press(key);
      t.near(far(camera.forward, forward), 0, 1e-6, `${key}: the direction of view`);
      t.equal(camera.target, PIVOT, `${key}: the target`);
    }
    let state = await press('PageUp');
    t.near(state.camera.distance, far([0, 2.75, -6], PIVOT) / 1.1, 1e-6, 'Page Up: the distance');
    t.check(state.saved && !state.undo, 'the scene is still saved');
    t.check(await screen.button('Keep view').isEnabled(), 'the view can be kept');
    state = await press('h');
    t.equal(state.camera.eye, [0, 2.75, -6], "H: the scene's own camera");
    state = await press('b');
    t.near(state.camera.distance, far([0, 2.75, -6], PIVOT) / 1.1, 1e-6, 'B: the view before');
    state = await press('Shift+B');
    t.equal(state.camera.eye, [0, 2.75, -6], 'Shift B: the view after');
    await screen.showPanel('Objects');
    await screen.page.getByRole('button', { name: /^rod/ }).click();
    await screen.stage.focus();
    state = await press('.');
    t.equal(state.camera.target, [0.2, 2.101, 0], 'full stop: the centre of the selected rod');
    state = await press('Home');
    t.near(state.camera.target[0], 0, 1e-9, 'Home: the centre of all objects');
    const { undo } = await press('k');
    t.equal(undo, 'keep the view', 'K: a change of the scene');
    state = await lab.get('/api/state');
    t.check(!state.saved, 'the scene with another camera is not saved');
    await t.axe(screen, 'views');
    await t.image(screen, 'viewport-views');
  },

  'undo of the scene leaves the view, and a saved scene keeps its own camera': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    await lab.post('/api/set', { set: { 'liquid.ior': 1.5 } });
    await lab.post('/api/camera', { orbit: [40, 10] });
    const { camera } = await lab.get('/api/state');
    await change(screen, () => screen.page.keyboard.press('Control+z'));
    t.equal(await lab.value('liquid.ior'), 1.33, 'the index after undo');
    t.equal((await lab.get('/api/state')).camera.eye, camera.eye, 'the view after undo');
    t.check((await lab.get('/api/state')).saved, 'the scene is as it was saved');
    await lab.post('/api/save', { file: 'own.yaml' });
    await lab.post('/api/open', { file: 'own.yaml' });
    t.equal((await lab.get('/api/state')).camera.eye, [0, 2.75, -6], 'the camera in the file');
    await lab.post('/api/camera', { orbit: [40, 10] });
    await lab.post('/api/view', { do: 'keep' });
    await lab.post('/api/save', { file: 'own.yaml' });
    await lab.post('/api/open', { file: 'own.yaml' });
    t.near(far((await lab.get('/api/state')).camera.eye, camera.eye), 0, 1e-9, 'the kept camera in the file');
    await lab.post('/api/camera', { orbit: [-15, 0] });
    t.check(!(await lab.get('/api/state')).view.kept, 'the view is not the camera of the scene');
    await lab.post('/api/set', { set: { 'camera.roll_deg': 0 } }); // what the view shows already
    t.check((await lab.get('/api/state')).view.kept, 'a set value of the camera does not keep the view');
  },
};
