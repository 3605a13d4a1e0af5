// Handles of the selected object: move, turn and scale, with snapping, by mouse and by keyboard; a vessel moves its
// contents along.
import { camera } from './optics.mjs';

const size = { width: 640, height: 480 };
const seen = camera({ position: [0, 6, -5], target: [0, 0, 0], fovDeg: 45, ...size }); // of shadow.yaml

async function change(screen, act) {
  const { generation } = await screen.lab.get('/api/state');
  await act();
  await screen.until((g) => window.lab.newestGeneration > g, generation);
  await screen.settled(generation + 1);
}

async function select(screen, name) {
  await screen.chooseTool('Object');
  await screen.page.getByRole('button', { name: new RegExp(`^${name}`) }).click();
  await screen.page.locator('.gizmo-handle').first().waitFor();
  await screen.quiet();
}

/** Drags a handle by CSS pixels. */
async function drag(screen, label, dx, dy) {
  const box = await screen.page.getByRole('button', { name: label, exact: true }).boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  await screen.page.mouse.move(x, y);
  await screen.page.mouse.down();
  await screen.page.mouse.move(x + dx, y + dy, { steps: 6 });
  await screen.quiet();
  await screen.page.mouse.up();
}

const far = (a, b) => Math.hypot(...a.map((x, i) => x - b[i]));

export const cases = {
  'the marks of an object are lines, through which it is seen': async (t) => {
    const lab = await t.lab('scenes/models.yaml');
    const screen = await t.open(lab, { width: 1366, height: 900 });
    for (const [name, tag] of [
      ['glass', 'circle'], // a mesh
      ['lamp', 'path'],
    ]) {
      await select(screen, name);
      await screen.page.locator(`.layer-object ${tag}`).first().waitFor({ state: 'attached' });
      const filled = await screen.page.evaluate(
        () =>
          [...document.querySelectorAll('.layer-object *')].filter((mark) => getComputedStyle(mark).fill !== 'none')
            .length,
      );
      t.equal(filled, 0, `filled marks of ${name}`);
    }
  },

  'a handle moves an object along its axis': async (t) => {
    const lab = await t.lab('tests/shadow.yaml');
    const screen = await t.open(lab, { width: 1920, height: 1080 });
    await screen.actualSize();
    const before = await lab.value('ball.position');
    await select(screen, 'ball');
    await change(screen, () => drag(screen, 'Move along x', 70, 0));
    const after = await lab.value('ball.position');
    t.equal(after.slice(1), before.slice(1), 'the other coordinates');
    const [from, to] = [seen.project(before), seen.project(after)];
    t.near(to.x - from.x, 70, 1.5, 'the object follows the pointer, pixels');
    await screen.page.getByRole('checkbox', { name: 'Snap' }).check();
    await change(screen, () => drag(screen, 'Move along z', 0, -40));
    const [, , z] = await lab.value('ball.position');
    t.more(z, before[2], 'a drag away from the camera increases z');
    t.near(z * 10, Math.round(z * 10), 1e-6, 'with Snap, z is a multiple of the step 0.1');
    await change(screen, () => screen.button('Undo').click());
    t.equal(await lab.value('ball.position'), after, 'one drag is one undo step');
    await t.axe(screen, 'handles');
    await t.image(screen, 'gizmo-move');
  },

  'handles turn by 15 degrees and scale by tenths': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    await select(screen, 'rod');
    await screen.stage.focus();
    await screen.page.keyboard.press('g');
    await screen.page.keyboard.down('Shift');
    await change(screen, () => drag(screen, 'Turn about z', -60, 30));
    await screen.page.keyboard.up('Shift');
    const [x, y, z] = await lab.value('rod.rotation');
    t.equal([x, y], [0, 0], 'the other angles');
    t.check(z !== 0 && Math.abs(z / 15 - Math.round(z / 15)) < 1e-9, `a multiple of 15 degrees: ${z}`);
    await t.image(screen, 'gizmo-turn');
    await change(screen, () => screen.button('Undo').click());
    await screen.page.getByRole('radio', { name: 'Scale' }).check({ force: true });
    await screen.page.keyboard.down('Shift');
    await change(screen, () => drag(screen, 'Scale', 28, -28));
    await screen.page.keyboard.up('Shift');
    const factor = (await lab.value('rod.size'))[1] / 3;
    t.more(factor, 1.2, 'a drag outwards enlarges');
    t.near(factor * 10, Math.round(factor * 10), 1e-6, 'by a multiple of a tenth');
  },

  'the vessel takes its water and its rod along, and the rod goes alone': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    const paths = ['vessel.position', 'liquid.position', 'rod.position'];
    const values = () => Promise.all(paths.map((path) => lab.value(path)));
    const first = await values();
    await select(screen, 'vessel');
    t.equal(await screen.page.evaluate(() => window.lab.choice.group.names), ['liquid', 'rod'], 'what is inside it');
    await change(screen, () => drag(screen, 'Move along x', 50, 0));
    let now = await values();
    t.more(now[0][0], 0.2, 'the vessel has moved');
    for (const k of [1, 2]) t.near(far(now[k], first[k]), far(now[0], first[0]), 1e-9, `${paths[k]} moves with it`);
    await t.image(screen, 'gizmo-vessel');
    await change(screen, () => screen.button('Undo').click());
    t.equal(await values(), first, 'one undo restores all three');
    await screen.page.getByRole('checkbox', { name: 'With contents' }).uncheck();
    await change(screen, () => drag(screen, 'Move along x', 50, 0));
    now = await values();
    t.equal(now.slice(1), first.slice(1), 'without contents, they stay');
    await change(screen, () => screen.button('Undo').click());
    await screen.page.getByRole('checkbox', { name: 'With contents' }).check();
    // In the image, by its wall.
    await screen.page.getByRole('button', { name: /^lamp/ }).click();
    const wall = await screen.page.evaluate(() => window.lab.view.project([-0.97, 2.6, -0.05]));
    await change(screen, async () => {
      await screen.drag(wall, { x: wall.x - 60, y: wall.y });
      await screen.quiet();
    });
    now = await values();
    t.more(far(now[0], first[0]), 0.2, 'the vessel is dragged in the image');
    for (const k of [1, 2])
      t.near(far(now[k], first[k]), far(now[0], first[0]), 1e-9, `${paths[k]} is dragged with it`);
    await change(screen, () => screen.button('Undo').click());
    await select(screen, 'rod');
    await change(screen, () => drag(screen, 'Move along y', 0, -40));
    now = await values();
    t.equal(now.slice(0, 2), first.slice(0, 2), 'the rod goes alone');
  },

  'handles by keyboard': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    await select(screen, 'rod');
    const press = (label, key) =>
      change(screen, () => screen.page.getByRole('button', { name: label, exact: true }).press(key));
    await press('Move along x', 'ArrowRight');
    t.near((await lab.value('rod.position'))[0], 0.3, 1e-9, 'one step along x');
    await press('Move along y', 'Shift+ArrowDown');
    t.near((await lab.value('rod.position'))[1], 2.091, 1e-9, 'a tenth of a step down');
    await screen.page.getByRole('button', { name: 'Move along y' }).press('g');
    await press('Turn about x', 'ArrowUp');
    t.equal(await lab.value('rod.rotation'), [15, 0, 0], 'a step about x');
    await screen.page.getByRole('button', { name: 'Turn about x' }).press('g');
    await press('Scale', 'ArrowRight');
    t.near((await lab.value('rod.size'))[1], 3.3, 1e-9, 'a step larger');
  },

  'a new solid is of glass, water or oil': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    await screen.showPanel('Objects');
    await screen.page.getByText('Other shapes, lights and files').click();
    const of = screen.page.getByRole('combobox', { name: 'New solids are of' });
    await of.selectOption('Water');
    await change(screen, () => screen.button('Sphere', true).click());
    t.equal(await lab.value('sphere.medium'), 'water', 'the medium of the new sphere');
    t.equal(await lab.value('sphere.transparency'), 1, 'its transparency');
    t.equal((await lab.get('/api/state')).trouble, null, 'the error of the scene');
    await t.image(screen, 'sphere-of-water');
    await change(screen, () => screen.button('Undo').click());
    t.check(!(await lab.get('/api/scene')).objects.some(({ name }) => name === 'sphere'), 'one undo removes it');
    await of.selectOption('Material plastic');
    await change(screen, () => screen.button('Box', true).click());
    const box = (await lab.get('/api/scene')).objects.find(({ name }) => name === 'box');
    t.equal(box.material, 'plastic', 'the material of a new box');
    await change(screen, () => screen.page.getByRole('combobox', { name: 'Set to' }).selectOption('Glass (BK7)'));
    t.equal(await lab.value('box.medium'), 'bk7', 'the medium after a choice in the details');
  },

  'everyday words find parameters': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    await screen.showPanel('Parameters');
    const search = screen.page.getByRole('searchbox', { name: /^Find a parameter/ });
    for (const [word, path] of [
      ['water', 'liquid.medium'],
      ['glass', 'vessel.ior'],
      ['zoom', 'camera.fov_deg'],
      ['brightness', 'lamp.intensity'],
      ['brigh', 'lamp.intensity'],
      ['oil', 'liquid.medium'],
      ['lamp brightness', 'lamp.intensity'],
      ['antialiasing', 'render.samples'],
      ['speed', 'render.threads'],
      ['colour', 'lamp.color'],
    ]) {
      await search.fill(word);
      const row = screen.page.locator(`.param[data-path="${path}"]:visible`);
      await row.first().waitFor();
      t.more(await row.count(), 0, `${word} finds ${path}`);
    }
  },
};
