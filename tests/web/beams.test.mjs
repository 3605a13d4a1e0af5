// The optical bench: beams over the image, their numbers, orbiting without tracing, ruler, screen.

const traces = (list) => list.filter((path) => /\/api\/(trace|beams)/.test(path)).length;

const text = (bytes) => Buffer.from(bytes).toString();

const lines = (screen) => screen.page.locator('.layer-bench .bench-ray');
const facts = (screen, index = 0) =>
  screen.page.getByRole('tabpanel', { name: 'Bench' }).locator('dl').nth(index).innerText();

async function withLaser(t, size) {
  const lab = await t.lab('scenes/rod.yaml');
  const screen = await t.open(lab, size);
  await screen.showPanel('Bench');
  await screen.button('Laser').click();
  await screen.until(() => window.lab.scene.objects.some((object) => object.name === 'laser'));
  const { generation } = await lab.post('/api/set', {
    set: { 'laser.position': [-2.5, 1.6, -0.4], 'laser.target': [0, 1.4, -0.4], 'laser.lambda_nm': 532 },
  });
  await screen.settled(generation);
  await lines(screen).nth(3).waitFor({ state: 'attached' });
  return { lab, screen };
}

export const cases = {
  'a laser has the numbers of the API at each hit, also at 1366 px': async (t) => {
    const { lab, screen } = await withLaser(t, { width: 1366, height: 768 });
    const { root } = JSON.parse(text((await lab.ask('GET', '/api/beams')).bytes)).beams[0].rays[0];
    const { hit } = root;
    await screen.page.getByRole('button', { name: /^start: vessel/ }).click();
    const shown = await facts(screen);
    const degrees = (cosine) => String((Math.acos(cosine) * 180) / Math.PI).slice(0, 7);
    for (const text of [
      degrees(hit.cos_i),
      degrees(hit.cos_t),
      String(hit.R_s).slice(0, 8),
      String(hit.R_p).slice(0, 8),
    ])
      t.check(shown.includes(text), `the panel lacks ${text}: ${shown}`);
    for (const name of ['Angles', 'R', 'T', 'Power']) {
      const head = screen.page
        .getByRole('tabpanel', { name: 'Bench' })
        .getByRole('columnheader', { name, exact: true });
      const { x, width } = await head.boundingBox();
      t.check(x + width <= 1350, `${name} is off the screen: ${x + width}`);
    }
    await t.image(screen, 'bench-light');
    await t.axe(screen, 'bench');
  },

  'the start and the target of a beam are dragged over the image': async (t) => {
    const { lab, screen } = await withLaser(t, { width: 1366, height: 768 });
    const param = async (name) => (await lab.get('/api/scene')).params.find(({ path }) => path === name).value;
    for (const [name, path, other] of [
      ['start', 'laser.position', 'laser.target'],
      ['target', 'laser.target', 'laser.position'],
    ]) {
      const [before, still] = [await param(path), await param(other)];
      const from = await screen.page.evaluate((p) => window.lab.view.project(p), before);
      await screen.drag(from, { x: from.x + 60, y: from.y - 40 });
      await screen.settled();
      const now = await param(path);
      const to = await screen.page.evaluate((p) => window.lab.view.project(p), now);
      t.near(to.x, from.x + 60, 2, `${name}: across the image`);
      t.near(to.y, from.y - 40, 2, `${name}: down the image`);
      t.equal(await param(other), still, `${name}: the other point stays`);
    }
    const handle = screen.page.getByRole('button', { name: /^start of laser/ });
    const before = await param('laser.position');
    await handle.press('Shift+ArrowUp'); /* farther along the line of sight */
    await screen.settled();
    const { camera } = await lab.get('/api/state');
    const way = (await param('laser.position')).map((x, axis) => x - before[axis]);
    const along = way.reduce((sum, x, axis) => sum + x * camera.forward[axis], 0);
    t.near(along, Math.hypot(...way), 1e-3, 'farther along the line of sight');
    t.more(along, 0.01, 'farther');
    await t.image(screen, 'beam-handles');
  },

  'orbiting draws the beams anew and traces nothing': async (t) => {
    const { lab, screen } = await withLaser(t);
    const before = await lines(screen).first().getAttribute('x1');
    const asked = await screen.asked();
    const { generation } = await lab.post('/api/camera', { orbit: [35, 5] });
    await screen.settled(generation);
    await screen.quiet();
    const after = await lines(screen).first().getAttribute('x1');
    t.check(before !== after, 'the beam stays where it was in the image');
    t.equal(traces(asked), 0, 'requests for rays while orbiting');
  },

  'the rays of a pixel stay in the scene until they are asked again': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab, { width: 1366, height: 900, dark: true });
    await screen.chooseTool('Inspect');
    await screen.clickPixel(400, 300);
    await screen.page.getByRole('treegrid', { name: 'Rays of the pixel' }).getByRole('row').nth(2).waitFor();
    await screen.quiet();
    const asked = await screen.asked();
    const { generation } = await lab.post('/api/camera', { orbit: [60, 0] });
    await screen.settled(generation);
    await screen.button('Trace again').waitFor();
    t.equal(traces(asked), 0, 'traces while orbiting');
    await t.image(screen, 'pixel-from-the-side');
    for (const name of ['Angles', 'R', 'T']) {
      const { x, width } = await screen.page.getByRole('columnheader', { name, exact: true }).boundingBox();
      t.check(x + width <= 1350, `${name} is off the screen: ${x + width}`);
    }
    await screen.button('Trace again').click();
    await screen.button('Trace again').waitFor({ state: 'hidden' });
    t.equal(traces(asked), 1, 'traces after asking again');
  },

  'ruler and screen': async (t) => {
    const { lab, screen } = await withLaser(t, { width: 1440, height: 900 });
    await screen.page.getByText('Measure: clicks in the image set points').click();
    const ends = await screen.page.evaluate(() => {
      const at = (p) => window.lab.view.project(p);
      return [at([-2.5, 1.6, -0.4]), at(window.lab.param('laser.target').value)];
    });
    await screen.clickPixel(Math.round(ends[0].x), Math.round(ends[0].y));
    await screen.page.getByText('Point 1').waitFor();
    const { root } = JSON.parse(text((await lab.ask('GET', '/api/beams')).bytes)).beams[0].rays[0];
    const hit = await screen.page.evaluate((p) => window.lab.view.project(p), root.hit.point);
    await screen.clickPixel(Math.round(hit.x), Math.round(hit.y));
    await screen.page.getByText('Distance 1–2').waitFor();
    const shown = await screen.page.getByRole('tabpanel', { name: 'Bench' }).innerText();
    t.check(
      shown.includes(root.hit.t.toPrecision(6).replace(/0+$/, '')),
      `the distance is not ${root.hit.t}: ${shown}`,
    );

    const reply = await lab.ask('GET', '/api/beams/screen?centre=-2,1.56,-0.4&normal=1,0,0&size=1,1&bins=4,4&rays=1');
    const answer = JSON.parse(text(reply.bytes));
    t.equal([answer.rays, answer.hits, answer.received], [1, 1, 1], 'rays, crossings and power on a screen');
    await screen.page.getByText('Screen', { exact: true }).click();
    for (const [name, value] of Object.entries({ 'Centre x': -2, 'Centre y': 1.56, 'Centre z': -0.4, Rays: 1 })) {
      await screen.page.getByRole('spinbutton', { name, exact: true }).fill(String(value));
      await screen.page.getByRole('spinbutton', { name, exact: true }).press('Enter');
    }
    await screen.button('Expose').click();
    await screen.page.getByText('N = 1 traced, 1 crossings').waitFor();
    await t.image(screen, 'bench-screen');
  },

  'a beam between two mirrors has 10 002 levels, and the page lists them': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab, { width: 1366, height: 768 });
    const found = await screen.page.evaluate(async () => {
      const { buildTree } = await import('./bench/ray_tree.js');
      const ray = { kind: 'reflect', origin: [0, 0, 0], direction: [1, 0, 0], throughput: [1, 1, 1], hit: null };
      let root = null;
      for (let depth = 10001; depth >= 0; depth--)
        root = { ...ray, depth, end: 'sky', far_end: [1, 0, 0, 0], children: root ? [root] : [] };
      const { rays, roots } = buildTree({ root });
      return [roots.length, rays.length, rays.at(-1).level, rays.at(-1).node.depth, rays.at(-1).parent.index];
    });
    t.equal(found, [1, 10002, 10002, 10001, 10000], 'roots, rays, and the last ray');
  },
};
