// The bench in two dimensions: the outlines are those of the command and of closed forms; objects are moved and turned
// by pointer and keys; the angles obey Snell's law; the exports.
import { readFile } from 'node:fs/promises';
import { join } from 'node:path';

const SCENE = 'tests/bench.yaml';

/** Waits until the drawing has the newest scene at rest, with all its detail. */
async function drawn(screen, cells = 400) {
  await screen.until(() => window.lab.change.idle());
  await screen.until((least) => {
    const { lab } = window;
    const { section } = lab;
    section.ask();
    return section.drawn >= lab.newestGeneration && section.cells >= least && section.fitted && section.steps;
  }, cells);
  await screen.quiet();
}

async function opened(t, scene = SCENE, size = undefined, view = null) {
  const lab = await t.lab(scene);
  const screen = await t.open(lab, size);
  await screen.button('2D bench', true).click();
  if (view) await screen.page.evaluate((name) => window.lab.section.open(name), view);
  await drawn(screen);
  return { lab, screen };
}

const areasOf = (screen) => screen.page.evaluate(() => window.lab.section.areas);
const valueOf = (screen, path) => screen.page.evaluate((name) => window.lab.param(name).value, path);

/** The place in the window of a point of the plane. */
const at = (screen, u, v) =>
  screen.page.evaluate(
    ([x, y]) => {
      const { node, port } = window.lab.section;
      const box = node.getBoundingClientRect();
      return { x: Math.round(box.left + port.x(x)), y: Math.round(box.top + port.y(y)) };
    },
    [u, v],
  );

async function drag(screen, from, by, keep = false) {
  const { mouse } = screen.page;
  await mouse.move(from.x, from.y);
  await mouse.down();
  await mouse.move(from.x + by.x, from.y + by.y, { steps: 6 });
  if (!keep) await mouse.up();
}

const settled = async (screen) => {
  await screen.until(() => window.lab.change.idle());
  await screen.until(() => window.lab.scene.generation >= window.lab.newestGeneration);
  await drawn(screen);
};

/** A change that a click makes, perhaps after requests. */
async function changing(screen, act) {
  const before = await screen.page.evaluate(() => window.lab.newestGeneration);
  await act();
  await screen.until((generation) => window.lab.newestGeneration > generation, before);
  await settled(screen);
}

export const cases = {
  'the outlines are those of the command, and of a lens': async (t) => {
    for (const [scene, view] of [
      [SCENE, 'top'],
      ['scenes/rod.yaml', 'front'],
    ]) {
      const { lab, screen } = await opened(t, scene, undefined, view);
      const { extent, cells, areas } = await screen.page.evaluate(() => window.lab.section);
      const words = ['--view', view, `--extent=${extent}`, '--cells', String(cells)];
      const place = await screen.page.evaluate(() => window.lab.section.plane.origin);
      await lab.run('section', scene, ...words, `--at=${place}`, '-o', 'section.json');
      const made = JSON.parse(await readFile(join(lab.folder, 'section.json'), 'utf8'));
      t.more(areas.length, 1, `${scene}: solids in the plane`);
      t.equal(areas, made.areas, `${scene}: areas`);
      t.equal(
        await screen.page.locator('.section-solid').evaluateAll((nodes) => nodes.map((node) => node.dataset.name)),
        areas.map(({ solid }) => solid),
        `${scene}: what is drawn`,
      );
      const shown = await screen.page.evaluate(() => {
        const { areas: all, port } = window.lab.section;
        const [u, v] = all[0].rings[0][0];
        const d = document.querySelector('.section-solid').getAttribute('d');
        return [d.split('L')[0], `M${port.x(u).toFixed(2)} ${port.y(v).toFixed(2)}`];
      });
      t.equal(shown[0], shown[1], `${scene}: the first point of the path`);
    }
  },

  'the points of a lens are on its spheres': async (t) => {
    const { screen } = await opened(t);
    const lens = (await areasOf(screen)).find(({ solid }) => solid === 'lens');
    const centres = [
      [-0.5 + 1.6, 0.5],
      [-0.5 + 0.4 - 1.6, 0.5],
    ];
    const off = lens.rings.flat().map((point) => {
      const onRim = Math.abs(Math.abs(point[1] - 0.5) - 0.7);
      return Math.min(onRim, ...centres.map(([u, v]) => Math.abs(Math.hypot(point[0] - u, point[1] - v) - 1.6)));
    });
    t.more(off.length, 40, 'points');
    t.less(Math.max(...off), 1e-9, 'the largest distance from the lens');
  },

  'a drag moves the lens by the distance of the pointer, and Undo restores it': async (t) => {
    const { screen } = await opened(t);
    const before = await valueOf(screen, 'lens.position');
    const { scale } = await screen.page.evaluate(() => ({ scale: window.lab.section.port.scale }));
    await drag(screen, await at(screen, -0.3, 0.55), { x: 60, y: -37 });
    await settled(screen);
    const after = await valueOf(screen, 'lens.position');
    t.near(after[0], before[0] + 60 / scale, 1e-9, 'to the right');
    t.equal(after[1], before[1], 'out of the plane');
    t.near(after[2], before[2] + 37 / scale, 1e-9, 'up');
    const lens = (await areasOf(screen)).find(({ solid }) => solid === 'lens');
    const left = Math.min(...lens.rings.flat().map(([u]) => u));
    t.near(left, after[0], 1e-3, 'the outline follows');
    await screen.page.keyboard.press('Control+z');
    await settled(screen);
    t.equal(await valueOf(screen, 'lens.position'), before, 'after Undo');

    await drag(screen, await at(screen, -0.3, 0.55), { x: 50, y: 0 }, true);
    await screen.until(() => window.lab.newestGeneration > 1);
    await screen.page.keyboard.press('Escape');
    await screen.page.mouse.up();
    await settled(screen);
    t.equal(await valueOf(screen, 'lens.position'), before, 'after Escape');
  },

  'snap: to the grid, and turns by 5 degrees': async (t) => {
    const { screen } = await opened(t);
    await screen.page.getByRole('checkbox', { name: 'Snap' }).check();
    await drag(screen, await at(screen, -0.3, 0.55), { x: 41, y: 23 });
    await settled(screen);
    const step = await screen.page.evaluate(() => window.lab.section.steps.minor);
    for (const axis of [0, 2]) {
      const value = (await valueOf(screen, 'lens.position'))[axis];
      t.near(value / step, Math.round(value / step), 1e-6, `coordinate ${axis} on the grid of ${step}`);
    }
    const knob = screen.button('Turn lens', true);
    const box = await knob.locator('.knob').boundingBox();
    await drag(screen, { x: box.x + box.width / 2, y: box.y + box.height / 2 }, { x: 31, y: 9 });
    await settled(screen);
    /* The lens lies: its rotation about y is a turn in the plane, about its own axis along x before. */
    const axis = await screen.page.evaluate(() => {
      const { areas } = window.lab.section;
      return areas.find(({ solid }) => solid === 'lens').rings.length;
    });
    t.equal(axis, 1, 'the turned lens is one area');
    await screen
      .button(/^prism/)
      .first()
      .focus();
    for (let i = 0; i < 3; i++) await screen.page.keyboard.press('r');
    await settled(screen);
    t.near(Math.abs((await valueOf(screen, 'prism.rotation'))[1]), 15, 1e-9, 'three turns by a key');
  },

  'a beam is moved and aimed': async (t) => {
    const { screen } = await opened(t);
    const { scale } = await screen.page.evaluate(() => ({ scale: window.lab.section.port.scale }));
    const from = await at(screen, -2, -1.2);
    await drag(screen, from, { x: 20, y: -30 });
    await settled(screen);
    const [start, target] = [await valueOf(screen, 'laser.position'), await valueOf(screen, 'laser.target')];
    t.near(start[0], -2 + 20 / scale, 1e-9, 'start to the right');
    t.near(target[2], -0.9 + 30 / scale, 1e-9, 'the target moves along');
    await screen.page.getByRole('checkbox', { name: 'Snap' }).check();
    const box = await screen.button('Turn laser', true).locator('.knob').boundingBox();
    await drag(screen, { x: box.x + 7, y: box.y + 7 }, { x: -10, y: 40 });
    await settled(screen);
    const [a, b] = [await valueOf(screen, 'laser.position'), await valueOf(screen, 'laser.target')];
    const angle = (Math.atan2(b[2] - a[2], b[0] - a[0]) * 180) / Math.PI;
    t.near(angle / 5, Math.round(angle / 5), 1e-6, `the direction is a multiple of 5 degrees: ${angle}`);
    t.check(Math.abs(angle) > 4, 'the beam was turned');
  },

  'the angles obey the law of refraction': async (t) => {
    const { screen } = await opened(t);
    await screen.page.keyboard.press('a');
    await screen.page.locator('.section-angle').first().waitFor();
    t.more(await screen.page.locator('.section-normal').count(), 3, 'normals');
    const names = await screen.page
      .locator('.section-hit')
      .evaluateAll((nodes) => nodes.map((node) => node.getAttribute('aria-label')));
    let checked = 0;
    for (const name of names) {
      const [i, r, n1, n2] = (name.match(/[\d.]+°?/g) ?? []).map(parseFloat);
      if (!name.includes('of refraction')) continue;
      const sin = (x) => Math.sin((x * Math.PI) / 180);
      t.near(n1 * sin(i), n2 * sin(r), 3e-4, name);
      checked++;
    }
    t.more(checked, 10, 'refractions');
    const hit = screen.page.locator('.section-hit').first();
    await hit.click();
    await screen.page.locator('.section-angle.index').first().waitFor();
    t.equal(await hit.getAttribute('aria-pressed'), 'true', 'a chosen hit keeps its angles');
    await t.image(screen, 'section-angles');
  },

  'by keys alone': async (t) => {
    const lab = await t.lab(SCENE);
    const screen = await t.open(lab);
    await screen.stage.focus();
    await screen.page.keyboard.press('2');
    await drawn(screen);
    t.equal(await screen.page.evaluate(() => document.activeElement.id), 'section', 'the focus');
    const { scale, u } = await screen.page.evaluate(() => ({ ...window.lab.section.port }));
    await screen.page.keyboard.press('+');
    await screen.page.keyboard.press('ArrowRight');
    const now = await screen.page.evaluate(() => ({ ...window.lab.section.port }));
    t.near(now.scale, 1.25 * scale, 1e-9, 'magnified');
    t.near(now.u, u + 48 / now.scale, 1e-9, 'scrolled');
    await screen.page.keyboard.press('0');
    await drawn(screen);
    await screen.page.keyboard.press('Tab');
    await screen.until(() => document.activeElement.dataset.name);
    const name = await screen.page.evaluate(() => document.activeElement.dataset.name);
    const before = await valueOf(screen, `${name}.position`);
    const step = await screen.page.evaluate(() => window.lab.section.steps.minor);
    await screen.page.keyboard.press('ArrowRight');
    await screen.page.keyboard.press('ArrowUp');
    await screen.page.keyboard.press('Shift+ArrowUp');
    await settled(screen);
    const after = await valueOf(screen, `${name}.position`);
    t.near(after[0], before[0] + step, 1e-9, 'right');
    t.near(after[2], before[2] + 1.1 * step, 1e-9, 'up, and a tenth');
    await t.axe(screen, 'the section');
    await screen.page.keyboard.press('Escape');
    await screen.page.keyboard.press('Escape');
    await screen.until(() => !window.lab.section.shown);
    t.equal(await screen.page.evaluate(() => document.activeElement.id), 'image', 'the focus returns to the image');
  },

  'the exports have what is seen': async (t) => {
    const { screen } = await opened(t);
    const [download] = await Promise.all([screen.page.waitForEvent('download'), screen.button('SVG', true).click()]);
    const text = await readFile(await download.path(), 'utf8');
    const rays = await screen.page.locator('.section-ray').count();
    const paths = await screen.page.evaluate((source) => {
      const file = new DOMParser().parseFromString(source, 'image/svg+xml');
      const strokes = [...document.querySelectorAll('.section-ray')].map((node) => node.getAttribute('d'));
      return strokes.filter((d) => file.querySelector(`path[d="${d}"][stroke-width]`)).length;
    }, text);
    t.more(rays, 10, 'rays');
    t.equal(paths, rays, 'rays in the file');
    t.check(text.includes('bk7') && !text.includes('class='), 'the legend, and no classes');
    await screen.page.evaluate(() => {
      window.print = () => {};
    });
    await screen.button('PDF', true).click();
    const pdf = await screen.page.pdf({ landscape: true });
    t.equal((pdf.toString('latin1').match(/\/Type\s*\/Page\b/g) ?? []).length, 1, 'pages');
    await screen.page.evaluate(() => window.dispatchEvent(new Event('afterprint')));
    t.equal(await screen.page.locator('.section-print').count(), 0, 'nothing is left after the print');
  },

  'turns in any plane, and the plane through the axis of a leaning solid': async (t) => {
    const { screen } = await opened(t);
    const found = await screen.page.evaluate(async () => {
      const { turnAbout } = await import('./bench/section_plane.js');
      const right = [0.6, 0.8, 0];
      const up = [-0.48, 0.36, 0.8];
      const normal = [0.64, -0.48, 0.6];
      return [
        turnAbout({ right, up, normal }, 35),
        turnAbout({ right: [1, 0, 0], up: [0, 0, 1], normal: [0, -1, 0] }, 35),
      ];
    });
    const turned = (point, angles) =>
      angles.reduce((p, degrees, axis) => {
        const [sin, cos] = [Math.sin((degrees * Math.PI) / 180), Math.cos((degrees * Math.PI) / 180)];
        const [i, j] = [(axis + 1) % 3, (axis + 2) % 3];
        const q = [...p];
        q[i] = cos * p[i] - sin * p[j];
        q[j] = sin * p[i] + cos * p[j];
        return q;
      }, point);
    const [c, s] = [Math.cos((35 * Math.PI) / 180), Math.sin((35 * Math.PI) / 180)];
    const to = turned([0.6, 0.8, 0], found[0]);
    [0.6 * c - 0.48 * s, 0.8 * c + 0.36 * s, 0.8 * s].forEach((x, axis) =>
      t.near(to[axis], x, 1e-12, `coordinate ${axis} of a turned vector`),
    );
    const top = turned([1, 0, 0], found[1]);
    t.near(top[2], s, 1e-12, 'from x towards z');
    await screen.page.evaluate(() => window.lab.set({ 'lens.rotation': [0, 0, -70] }));
    await screen.page.evaluate(() => window.lab.choice.choose('lens'));
    await screen.page.evaluate(() => window.lab.section.open('axis'));
    await screen.until(() => window.lab.section.view === 'axis');
    await settled(screen);
    const { right } = await screen.page.evaluate(() => window.lab.section.plane);
    t.near(Math.abs(right[0]), Math.cos((20 * Math.PI) / 180), 1e-12, 'the axis along the page');
  },

  'an orthographic image shows the same height at the pivot': async (t) => {
    const lab = await t.lab(SCENE);
    const screen = await t.open(lab);
    await screen.button('Camera', true).click();
    const before = await lab.get('/api/state');
    await screen.button('Orthographic').click();
    await screen.until(() => window.lab.state.camera.parallel);
    await screen.settled();
    const { camera, view } = await lab.get('/api/state');
    t.near(camera.half_height, before.camera.half_height * before.view.distance, 1e-4, 'half the height');
    t.near(view.distance, before.view.distance, 1e-9, 'the distance');
    t.equal(await screen.button('Orthographic').getAttribute('aria-pressed'), 'true', 'the button');
    await screen.button('Orthographic').click();
    await screen.until(() => !window.lab.state.camera.parallel);
    t.near((await lab.get('/api/state')).camera.half_height, before.camera.half_height, 1e-12, 'perspective again');
  },

  'a beam is added in the plane, and a plane goes through the selected object': async (t) => {
    const { lab, screen } = await opened(t, 'scenes/rod.yaml');
    t.equal(await screen.page.locator('.section-ray').count(), 0, 'rays of a scene without beams');
    await screen.button('Beam', true).click();
    await screen.page.locator('.section-ray').nth(2).waitFor({ state: 'attached' });
    t.equal((await lab.get('/api/beams')).beams.length, 1, 'beams');
    t.more(await screen.page.locator('.section-handle').count(), 1, 'handles of the new beam');
    await screen.page.evaluate(() => window.lab.choice.choose('rod'));
    await screen.page.getByRole('group', { name: 'Section' }).getByText('Top', { exact: true }).click();
    await drawn(screen);
    const { origin } = await screen.page.evaluate(() => window.lab.section.plane);
    t.near(origin[1], 2.101, 1e-9, 'through the middle of the rod');
    await t.image(screen, 'section-top');
  },

  'on a phone, dark': async (t) => {
    const { screen } = await opened(t, SCENE, { width: 412, height: 915, dark: true, touch: true });
    await t.axe(screen, 'the section on a phone');
    await t.image(screen, 'section-phone');
  },

  'from the start page to light in a lens in two actions; each thing of the palette meets light': async (t) => {
    const lab = await t.lab();
    const screen = await t.open(lab);
    await screen.page.getByRole('button', { name: /^Free experiment/ }).click();
    await screen.button('Lens', true).click();
    await screen.until(() => window.lab.section.hits.filter(({ hit }) => hit.solid === 'lens').length === 14);
    await screen.page.locator('.section-formula').waitFor();
    await t.axe(screen, 'a free experiment');
    await t.image(screen, 'free-experiment');
    const objects = async () => (await lab.get('/api/scene')).objects.map(({ name }) => name);
    const undo = async () => {
      await changing(screen, () => screen.button('Undo').click());
      t.equal(await objects(), ['table', 'lamp', 'board'], 'one undo');
    };
    await settled(screen);
    await undo();

    const f = screen.page.getByRole('group', { name: 'The next lens' }).getByLabel('f', { exact: true });
    for (const [form, focus] of [
      ['Biconvex', 8],
      ['Meniscus', 25],
      ['Plano-concave', -12],
    ]) {
      await screen.page.getByRole('combobox', { name: 'Form of the lens' }).selectOption(form);
      await f.fill(String(focus));
      await f.press('Enter');
      await changing(screen, () => screen.button('Lens', true).click());
      const { efl } = (await lab.get('/api/lens')).sections['first-order'].values;
      t.near(efl, 10 * focus, Math.abs(0.001 * 10 * focus), `${form}: focal length in mm`);
      await undo();
    }
    for (const item of await screen.page.locator('.palette-item').all()) {
      const name = await item.innerText();
      await changing(screen, () => item.click());
      const { segments, hits } = await screen.page.evaluate(() => window.lab.section);
      t.more(segments.length, 0, `${name}: rays`);
      const added = (await objects()).filter(
        (each) => !['table', 'lamp', 'board', 'ray', 'rays', 'source'].includes(each),
      );
      if (added.length)
        t.check(
          hits.some(({ hit }) => hit.solid === added[0]),
          `${name}: light on ${added[0]}`,
        );
      await undo();
    }
  },

  'a point source has a real or a virtual image where the lens formula puts it': async (t) => {
    const lab = await t.lab(SCENE);
    await lab.post('/api/open', { new: 'bench' });
    const screen = await t.open(lab);
    await screen.page.evaluate(() => window.lab.section.open('top', { at: 2.5, window: [-20, 20, -12, 12] }));
    await drawn(screen);
    await screen.showPanel('Objects');
    for (const name of ['Point source', 'Lens']) await changing(screen, () => screen.button(name, true).click());
    const imageFor = async (x) => {
      const move = (to) => window.lab.set({ 'source.position': [to, 2.5, 0], 'source.target': [0, 2.5, 0] });
      await changing(screen, () => screen.page.evaluate(move, x));
      return screen.page.evaluate(() => window.lab.section.images);
    };
    const [real] = await imageFor(-15);
    t.check(real.real && real.point, 'beyond the focus: a real image');
    t.near(1 / real.formula.a + 1 / real.formula.b, 1 / real.formula.f, 0.001, '1/a + 1/b');
    t.near(real.formula.f, 10, 0.01, 'f');
    const [virtual] = await imageFor(-6);
    t.check(!virtual.real, 'within the focal length: a virtual image');
    t.near(1 / virtual.formula.a + 1 / virtual.formula.b, 1 / virtual.formula.f, 0.001, '1/a + 1/b, b below 0');
    t.less(virtual.formula.b, 0, 'b');
    t.more(await screen.page.locator('.section-extension').count(), 5, 'extensions');
    t.match(await screen.page.locator('.section-images').textContent(), /virtual image/, 'its name');
    await t.image(screen, 'virtual-image');
  },

  'without beams the plane is through the glass; the legend of a telephone covers no solid': async (t) => {
    const { screen } = await opened(t, 'scenes/rod.yaml', { width: 390, height: 844, touch: true });
    const { view, plane } = await screen.page.evaluate(() => window.lab.section);
    t.equal([view, plane.origin], ['front', [0, 0, 0]], 'the plane');
    const [legend, vessel, lamp] = await Promise.all(
      ['rect.section-plate', '.section-solid[data-name="rod"]', '.section-light'].map((at) =>
        screen.page.locator(at).first().boundingBox(),
      ),
    );
    t.check(legend.y + legend.height <= vessel.y, 'the legend is above the rod');
    t.check(lamp, 'the lamp is drawn');
  },
};
