// Rays that leave the scene run to the edge of the canvas: twenty random beams over the image, a fan and a pixel's
// rays, from several views and at several magnifications, against the closed form: the projected ray meets each edge of
// the canvas at one point; of these, of its ends and of its vanishing point, those in front of the camera and on the
// canvas bound the line.

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const minus = (a, b) => a.map((x, k) => x - b[k]);
const along = (a, d, s) => a.map((x, k) => x + s * d[k]);
const text = (bytes) => Buffer.from(bytes).toString();

/** A fixed stream of numbers in -1..1 (Park and Miller). */
function randomStream(seed) {
  let state = seed;
  return () => {
    state = (state * 48271) % 2147483647;
    return (2 * state) / 2147483647 - 1;
  };
}

/** The first and the last point of the ray on the canvas; null where it does not cross it. end: distance of its hit,
 * or Infinity. */
function bounds({ camera, width, height, frame }, from, d, end) {
  const { eye, forward, right, up, half_width: w, half_height: h, parallel } = camera;
  const o = minus(from, eye);
  const [depth, rate] = [dot(o, forward), dot(d, forward)];
  const image = (v) => {
    const size = parallel ? 1 : dot(v, forward);
    return [((dot(v, right) / size / w + 1) * width) / 2, ((1 - dot(v, up) / size / h) * height) / 2];
  };
  const inside = ([x, y]) => {
    const slack = 1e-7 * (frame.right - frame.left);
    return x > frame.left - slack && x < frame.right + slack && y > frame.top - slack && y < frame.bottom + slack;
  };
  /* Where x right / (z w) = u. */
  const crossing = (axis, half, u) => {
    const [a, b] = parallel ? [u * half, 0] : [u * half * depth, u * half * rate];
    return (a - dot(o, axis)) / (dot(d, axis) - b);
  };
  const distances = [
    0,
    end,
    parallel && (end < Infinity || depth < 0) ? -depth / rate : -1,
    ...[frame.left, frame.right].map((x) => crossing(right, w, (2 * x) / width - 1)),
    ...[frame.top, frame.bottom].map((y) => crossing(up, h, 1 - (2 * y) / height)),
  ];
  /* From in front of the plane of a parallel view, a ray leaves past the plane. */
  const near = !parallel ? 1e-12 : end === Infinity && depth >= 0 ? -Infinity : -1e-12;
  const ahead = (s) => s >= 0 && s <= end && Number.isFinite(s) && depth + s * rate >= near;
  const found = distances.filter(ahead).map((s) => [s, image(along(o, d, s))]);
  if (end === Infinity && !parallel && rate > 0) found.push([Infinity, image(d)]);
  const kept = found.filter(([, point]) => inside(point)).sort(([a], [b]) => (a < b ? -1 : a > b ? 1 : 0));
  return kept.length > 1 && kept[0][0] < kept.at(-1)[0] ? [kept[0][1], kept.at(-1)[1]] : null;
}

/** What the page shows now: its camera, and its canvas in pixels of the image. */
const viewOf = (screen) =>
  screen.page.evaluate(() => {
    const { view, state } = window.lab;
    const { clientWidth, clientHeight } = view.stage;
    const corner = view.toScreen(0, 0);
    const frame = {
      left: -corner.x / view.scale,
      top: -corner.y / view.scale,
      right: (clientWidth - corner.x) / view.scale,
      bottom: (clientHeight - corner.y) / view.scale,
    };
    return { camera: state.camera, width: view.width, height: view.height, frame };
  });

const drawnLines = (screen, selector) =>
  screen.page
    .locator(selector)
    .evaluateAll((lines) =>
      lines.map((line) => [
        ['x1', 'y1'].map((name) => Number(line.getAttribute(name))),
        ['x2', 'y2'].map((name) => Number(line.getAttribute(name))),
      ]),
    );

const flat = (node) => [node, ...node.children.flatMap(flat)];

/** [from, direction, distance] of the rays of a tree that are drawn. */
const raysOf = (root) =>
  flat(root)
    .filter(({ end }) => !end.startsWith('cut'))
    .map((node) => [node.origin, node.direction, node.hit ? node.hit.t : (node.light_distance ?? Infinity)]);

const pathsOf = ({ points, direction, end }) => {
  const pieces = points.slice(1).map((point, i) => {
    const way = minus(point, points[i]);
    return [points[i], way.map((x) => x / Math.hypot(...way)), Math.hypot(...way)];
  });
  return end === 'sky' ? [...pieces, [points.at(-1), direction, Infinity]] : pieces;
};

/** Compares the lines of the page with the closed form; the number of ends at the edge of the canvas. */
async function compare(t, screen, selector, rays, what) {
  const view = await viewOf(screen);
  const drawn = (await drawnLines(screen, selector)).filter(([a, b]) => Math.hypot(a[0] - b[0], a[1] - b[1]) > 1e-3);
  const wanted = rays
    .map(([from, d, end]) => bounds(view, from, d, end))
    .filter((ends) => ends && Math.hypot(ends[0][0] - ends[1][0], ends[0][1] - ends[1][1]) > 1e-3);
  if (!t.equal(drawn.length, wanted.length, `${what}: lines`)) return 0;
  const off = drawn.map((line, i) =>
    Math.max(...[0, 1].map((e) => Math.hypot(line[e][0] - wanted[i][e][0], line[e][1] - wanted[i][e][1]))),
  );
  t.less(Math.max(0, ...off), 1e-3, `${what}: largest distance of an end from the closed form, pixels`);
  const { left, top, right, bottom } = view.frame;
  return drawn.filter(([, [x, y]]) =>
    [x - left, right - x, y - top, bottom - y].some((away) => Math.abs(away) < 1e-6 * (right - left)),
  ).length;
}

/** Magnifies by the buttons' function, about the middle of the stage. */
async function magnify(screen, factor) {
  await screen.page.evaluate((by) => (by ? window.lab.view.zoom(by) : window.lab.view.fit()), factor);
  await screen.quiet();
}

const VIEWS = [
  ['as it is', {}, null],
  ['turned', { turn: [60, 10] }, null],
  ['from the side', { orbit: [75, 20] }, null],
  ['orthographic', { orbit: [30, 0] }, 'orthographic'],
];

async function compareViews(t, lab, screen, selector, rays, what) {
  let edges = 0;
  for (const [name, move, projection] of VIEWS) {
    if (projection) await lab.post('/api/set', { set: { 'camera.projection': projection, 'camera.view_height': 5 } });
    const { generation } = await lab.post('/api/camera', move);
    await screen.settled(generation);
    await screen.quiet();
    edges += await compare(t, screen, selector, rays, `${what}, ${name}`);
    await t.image(screen, `ray-lines-${what}-${name.replaceAll(' ', '-')}`.replaceAll(' ', '-'));
    for (const factor of [4, 0.1]) {
      await magnify(screen, factor);
      edges += await compare(t, screen, selector, rays, `${what}, ${name}, magnified by ${factor}`);
    }
    await magnify(screen, 0);
  }
  t.more(edges, 10, `${what}: ends at the edge of the canvas`);
}

export const cases = {
  'twenty random beams': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const random = randomStream(47);
    const set = { 'ground.visible': 'off' };
    for (let k = 0; k < 20; k++) {
      const { name } = await lab.post('/api/objects', { kind: 'beam' });
      const position = [4 * random(), 2 + 2 * random(), 6 * random()];
      const direction = [random(), random(), random()];
      set[`${name}.position`] = position;
      set[`${name}.direction`] =
        k % 4 ? direction : minus([0.2 * direction[0], 1.5, 0.2], position); /* at the vessel */
    }
    await lab.post('/api/set', { set });
    const screen = await t.open(lab);
    await screen.showPanel('Bench');
    await screen.settled();
    const { beams } = JSON.parse(text((await lab.ask('GET', '/api/beams')).bytes));
    t.equal(beams.length, 20, 'beams');
    const rays = beams.flatMap((beam) => beam.rays.flatMap(({ root }) => raysOf(root)));
    t.more(rays.filter(([, , end]) => end === Infinity).length, 20, 'rays that leave the scene');
    await compareViews(t, lab, screen, '.layer-bench .bench-ray', rays, 'beams');
  },

  'a point of a ray that left past the plane of an orthographic camera': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const { name } = await lab.post('/api/objects', { kind: 'beam' });
    const camera = { position: [0, 1.5, -6], target: [0, 1.5, 0], projection: 'orthographic', view_height: 5 };
    const set = { [`${name}.position`]: [0, 1.5, -5], [`${name}.direction`]: [1, 0.2, -2] };
    for (const [key, value] of Object.entries(camera)) set[`camera.${key}`] = value;
    await lab.post('/api/set', { set });
    const screen = await t.open(lab);
    await screen.showPanel('Bench');
    await screen.settled();
    await screen.page.getByText('Measure: clicks in the image set points').click();
    await screen.quiet();
    await screen.clickPixel(580, 264); /* 1.5 to the right of the middle, where 120 pixels are a unit */
    await screen.page.getByText('Point 1').waitFor();
    const shown = await screen.page.getByRole('tabpanel', { name: 'Bench' }).innerText();
    const point = shown
      .match(/Point 1\s+(.*)/)[1]
      .replaceAll('\u2212', '-')
      .match(/-?[\d.]+/g)
      .map(Number);
    const off = Math.max(...minus(point, [1.5, 1.8, -8]).map(Math.abs));
    t.less(off, 0.02, `distance of ${point} from the ray at the pointer`);
  },

  'a fan of rays': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    await screen.showPanel('Bench');
    const fan = screen.page
      .getByRole('tabpanel', { name: 'Bench' })
      .locator('details')
      .filter({ has: screen.page.locator('.group-title', { hasText: 'Fan of rays' }) });
    await fan.locator('summary').click();
    await fan.getByRole('button', { name: 'Trace' }).click();
    await fan.getByText('21, ').waitFor();
    await screen.quiet();
    const path = await fan.locator('img').getAttribute('data-path');
    const query = path.replace(/^.*\?/, '').replace(/&of=.*$/, '');
    const { rays } = await lab.get(`/api/fan?${query}`);
    await compareViews(t, lab, screen, '.layer-bench .bench-fan-ray', rays.flatMap(pathsOf), 'fan');
  },

  'the rays of a pixel, over the image and in its plots': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab, { width: 1366, height: 900 });
    await screen.chooseTool('Inspect');
    await screen.clickPixel(400, 300);
    await screen.page.getByRole('treegrid', { name: 'Rays of the pixel' }).getByRole('row').nth(2).waitFor();
    await screen.quiet();
    const { root } = await lab.get('/api/trace?x=400&y=300');
    const first = root.throughput.reduce((sum, x) => sum + x, 0);
    const heavy = (node, parent) => {
      const of = node.kind === 'shadow' ? parent : node;
      const weight = of.throughput.reduce((sum, x) => sum + x, 0) / first;
      return { ...node, weight, children: node.children.map((child) => heavy(child, node)) };
    };
    const rays = flat(heavy(root, null))
      .filter(({ weight, end }) => weight >= 0.002 && !end.startsWith('cut'))
      .map((node) => [node.origin, node.direction, node.hit ? node.hit.t : (node.light_distance ?? Infinity)]);
    const { generation } = await lab.post('/api/camera', { orbit: [50, 10] });
    await screen.settled(generation);
    await screen.quiet();
    await compare(t, screen, '.layer-pixel line.ray:not(.ray-cut)', rays, 'pixel');
    await t.image(screen, 'ray-lines-pixel');
    const plots = await screen.page.locator('.ray-plot').evaluateAll((all) =>
      all.map((plot) => {
        const value = (node, names) => names.map((name) => Number(node.getAttribute(name)));
        const frame = value(plot.querySelector('.ray-frame'), ['x', 'y', 'width', 'height']);
        const lines = [...plot.querySelectorAll('line.ray-reflect, line.ray-refract')];
        return { frame, ends: lines.map((line) => value(line, ['x2', 'y2'])) };
      }),
    );
    t.equal(plots.length, 2, 'plots');
    for (const { frame, ends } of plots) {
      const [x, y, width, height] = frame;
      const edge = ([u, v]) => [u - x, x + width - u, v - y, y + height - v].some((away) => Math.abs(away) < 0.02);
      t.more(ends.filter(edge).length, 0, 'rays that run to the edge of a plot');
    }
  },
};
