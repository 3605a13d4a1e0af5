// How a pupil measures in each lesson: from the rays that the section shows, where the tool's handles go.
// exports: handsOf(screen, name) -> [[handle, x, y], ..] in pixels of the page, in the order in which they are dragged

/** Runs in the page: the rays as they are drawn, and what to do with them. */
function plan(name) {
  const { section } = window.lab;
  const { port, plane, segments, hits, areas, node: drawing } = section;
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const flat = (p) => {
    const d = p.map((x, axis) => x - plane.origin[axis]);
    return [dot(d, plane.right), dot(d, plane.up)];
  };
  const angle = ({ along }, turned = 0) =>
    (Math.atan2(dot(along, plane.up), dot(along, plane.right)) * 180) / Math.PI + turned;
  const of = (beam, number = 0) => segments.filter((each) => each.beam === beam && each.ray.number === number);
  const last = (beam, number) => of(beam, number).at(-1).line;
  const end = ({ line }) => flat([0, 1, 2].map((axis) => line.from[axis] + line.along[axis] * line.end));
  const along = ({ from, along: way }, s) => flat(from.map((x, axis) => x + s * way[axis]));
  const crossing = (a, b) => {
    const [p, q] = [flat(a.from), flat(b.from)];
    const [d, e] = [a, b].map(({ along: way }) => [dot(way, plane.right), dot(way, plane.up)]);
    const t = ((q[0] - p[0]) * e[1] - (q[1] - p[1]) * e[0]) / (d[0] * e[1] - d[1] * e[0]);
    return [p[0] + t * d[0], p[1] + t * d[1]];
  };
  const normal = ([x, y, z]) => (Math.atan2(dot([x, y, z], plane.up), dot([x, y, z], plane.right)) * 180) / Math.PI;
  const dial = (at, first, second) => {
    const to = (degrees) => [
      port.x(at[0]) + 150 * Math.cos((degrees * Math.PI) / 180),
      port.y(at[1]) - 150 * Math.sin((degrees * Math.PI) / 180),
    ];
    return [
      ['0', port.x(at[0]), port.y(at[1])],
      ['1', ...to(first)],
      ['2', ...to(second)],
    ];
  };
  const ruler = (a, b) => [
    ['0', port.x(a[0]), port.y(a[1])],
    ['1', port.x(b[0]), port.y(b[1])],
  ];
  const screen = ([u, v]) => [['all', port.x(u), port.y(v)]];
  const rays = {
    'broken-rod': () => dial(end(of('sight')[0]), angle(of('sight')[0].line), angle(of('sight')[2].line)),
    mirror: () => {
      const image = crossing(last('rays', 2), last('rays', 3));
      return ruler([end(of('rays', 2)[0])[0], image[1]], image);
    },
    'apparent-depth': () => {
      const image = crossing(last('sight', 1), last('sight', 3));
      return ruler([image[0], end(of('sight', 2)[0])[1]], image);
    },
    coin: () => dial(end(of('sight')[0]), 270, angle(of('sight')[1].line)),
    'critical-angle': () => {
      const first = segments.filter(({ one }) => one.level === 1 && one.node.hit?.tir);
      const best = first.reduce((a, b) =>
        a.one.node.hit.snell.incidence_deg < b.one.node.hit.snell.incidence_deg ? a : b,
      );
      return dial(end(best), 270, angle(best.line, 180));
    },
    window: () => {
      const out = segments.filter(
        ({ one }) => one.level === 1 && one.node.hit && !one.node.hit.tir && one.node.hit.solid === 'liquid',
      );
      const far = out.map(end).reduce((a, b) => (b[0] > a[0] ? b : a));
      return ruler([0, far[1]], far);
    },
    fibre: () => {
      const [, inside] = of('rays');
      return dial(end(inside), normal(inside.one.node.hit.normal), angle(inside.line, 180));
    },
    lens: () => ruler([0, 0], crossing(last('sun', 6), last('sun', 7))),
    arrow: () => ruler([0, 0], crossing(last('sight', 4), last('sight', 5))),
    'lens-formula': () => screen(crossing(last('rays', 3), last('rays', 4))),
    prism: () => dial(end(of('ray')[0]), angle(of('ray')[0].line), angle(last('ray', 0))),
    rainbow: () => {
      const back = segments.filter(
        ({ beam, one, line }) => beam === 'ray' && one.level === 4 && one.node.kind === 'refract' && line.along[2] < 0,
      )[0];
      return dial(flat(back.line.from), angle(of('ray')[0].line, 180), angle(back.line));
    },
    sea: () => screen([-0.88 + Math.log(2) / 0.6, 1]),
    brewster: () => {
      const [ray] = of('ray');
      return dial(end(ray), normal(ray.one.node.hit.normal), angle(ray.line, 180));
    },
    malus: () => screen(flat([0, 0, -3])),
    soap: () => screen(along(of('laser')[1].line, 3)),
    slant: () => screen(along(of('laser')[1].line, 2)),
    plates: () => screen(flat([0, 0, 3.6])),
    'pale-glass': () => {
      const up = segments.filter(
        ({ one, line }) => one.level === 4 && one.node.kind === 'refract' && line.along[1] > 0,
      )[0];
      return ruler(end(of('ray')[0]), flat(up.line.from));
    },
    slime: () => {
      const top = areas.find(({ solid }) => solid === 'body').rings[0].reduce((a, b) => (b[1] > a[1] ? b : a));
      return ruler([top[0], 3], top);
    },
    threads: () => dial(flat(of('sight')[0].line.from), angle(of('sight', 0)[0].line), angle(of('sight', 8)[0].line)),
  }[name];
  const box = drawing.getBoundingClientRect();
  return (
    rays && {
      count: segments.length,
      hits: hits.length,
      to: rays().map(([which, x, y]) => [which, box.x + x, box.y + y]),
    }
  );
}

export const handsOf = (screen, name) => screen.page.evaluate(plan, name);

/** Drags the tool's handles with the mouse. */
export async function measureByHand(screen, { to }) {
  const { mouse } = screen.page;
  for (const [which, x, y] of to) {
    const from = await screen.page.evaluate((handle) => {
      const node = document.querySelector(
        `.section-tools [data-handle="${handle}"] .knob, .section-tools path[data-handle="${handle}"]`,
      );
      const box = node.getBoundingClientRect();
      return [box.x + box.width / 2, box.y + box.height / 2];
    }, which);
    await mouse.move(...from);
    await mouse.down();
    await mouse.move(x, y, { steps: 2 });
    await mouse.up();
  }
}
