// Objects are added, selected in the image, dragged, rotated, given a material, copied and removed.
import { camera } from './optics.mjs';

const eye = [0, 6, -5];
const view = camera({ position: eye, target: [0, 0, 0], fovDeg: 45, width: 640, height: 480 });

async function change(screen, act) {
  const { generation } = await screen.lab.get('/api/state');
  await act();
  await screen.until((g) => window.lab.newestGeneration > g, generation);
  await screen.settled(generation + 1);
  return screen.lab.get('/api/state');
}

/** The centre of the blue pixels. */
function blue({ width, height, data }) {
  let [n, sx, sy] = [0, 0, 0];
  for (let y = 0; y < height; y++)
    for (let x = 0; x < width; x++) {
      const i = (y * width + x) * 4;
      if (data[i + 2] > 1.5 * data[i]) [n, sx, sy] = [n + 1, sx + x + 0.5, sy + y + 0.5];
    }
  return { n, x: sx / n, y: sy / n };
}

const names = async (lab) => (await lab.get('/api/scene')).objects.map((object) => object.name);

export const cases = {
  'a ball is dragged in the image': async (t) => {
    const lab = await t.lab('tests/shadow.yaml');
    const screen = await t.open(lab, { width: 1920, height: 1080 });
    await screen.actualSize();
    const before = await lab.value('ball.position');
    const middle = view.project(before);
    await screen.chooseTool('Object');
    await screen.clickPixel(Math.floor(middle.x), Math.floor(middle.y));
    await screen.page.getByRole('heading', { name: 'ball', exact: true }).waitFor();
    const seen = blue(await screen.pixels());
    t.near(seen.x, middle.x, 1, 'the image of the ball is at its projection, x');
    await change(screen, async () => {
      await screen.drag(middle, { x: middle.x + 90, y: middle.y + 30 });
      await screen.quiet();
    });
    const after = await lab.value('ball.position');
    const there = view.project(after);
    // The pointer grabbed the point of the ball that is nearest to the camera.
    const away = before.map((v, i) => v - eye[i]);
    const held = after.map((v, i) => v - (0.3 * away[i]) / Math.hypot(...away));
    t.near(view.project(held).x, middle.x + 90, 1, 'the grabbed point stays under the pointer, x');
    t.near(view.project(held).y, middle.y + 30, 1, 'the grabbed point stays under the pointer, y');
    const moved = blue(await screen.pixels());
    t.near(moved.x - seen.x, there.x - middle.x, 1.5, 'the image of the ball moves with it, x');
    t.near(moved.y - seen.y, there.y - middle.y, 1.5, 'the image of the ball moves with it, y');
    await change(screen, () => screen.button('Undo').click());
    t.equal(await lab.value('ball.position'), before, 'the position after one undo');
  },

  'buttons and keys move and rotate an object in steps': async (t) => {
    const lab = await t.lab('tests/shadow.yaml');
    const screen = await t.open(lab);
    await screen.showPanel('Objects');
    await screen.page.getByRole('button', { name: /^ball/ }).click();
    const before = await lab.value('ball.position');
    await change(screen, () => screen.button('Move: plus x').click());
    t.near((await lab.value('ball.position'))[0] - before[0], 0.1, 1e-9, 'a step along x, scene units');
    await change(screen, () => screen.button('Move: minus y').press('Enter'));
    t.near((await lab.value('ball.position'))[1] - before[1], -0.1, 1e-9, 'a step down, scene units');
    await change(screen, () => screen.button('Turn: plus z').click());
    t.equal(await lab.value('ball.rotation'), [0, 0, 15], 'a rotation about z, degrees');
  },

  'the whole scene is moved, rotated and scaled': async (t) => {
    const lab = await t.lab('tests/shadow.yaml');
    const screen = await t.open(lab, { width: 1920, height: 1080 });
    await screen.actualSize();
    await screen.showPanel('Objects');
    await screen.page.getByText('Whole scene').click();
    const values = async () =>
      Promise.all(['ball.position', 'lamp.position', 'camera.position'].map((path) => lab.value(path)));
    const [ball, lamp, eyeAt] = await values();
    await change(screen, () => screen.button('Move all: plus x').click());
    let now = await values();
    t.near(now[0][0] - ball[0], 0.1, 1e-9, 'the ball moves');
    t.near(now[1][0] - lamp[0], 0.1, 1e-9, 'the lamp moves');
    t.equal(now[2], eyeAt, 'the camera does not move');
    await change(screen, () => screen.button('Undo').click());
    await screen.page.getByRole('checkbox', { name: 'Camera' }).check();
    const before = await screen.pixels();
    await change(screen, () => screen.button('Turn all: plus y').click());
    await change(screen, () => screen.button('Scale all: larger').click());
    now = await values();
    t.near(
      Math.hypot(...now[2]),
      1.1 * Math.hypot(...eyeAt),
      1e-9,
      'scaled with the camera: its distance is multiplied by the factor',
    );
    const after = await screen.pixels();
    const different = before.data.filter((value, i) => Math.abs(value - after.data[i]) > 2).length;
    t.check(different < 4 * 50, `scaled with the camera, ${different} values of the image differ`);
    await screen.page.getByRole('checkbox', { name: 'Solids' }).uncheck();
    await screen.page.getByRole('checkbox', { name: 'Camera' }).uncheck();
    const [stays] = await values();
    await change(screen, () => screen.button('Move all: minus y').click());
    t.equal((await values())[0], stays, 'moving only the lights does not move the ball');
    await t.axe(screen, 'steps of the whole scene');
    await t.image(screen, 'whole-scene');
  },

  'dragging with a rolled camera': async (t) => {
    const lab = await t.lab('tests/shadow.yaml');
    const screen = await t.open(lab, { width: 1920, height: 1080 });
    await screen.actualSize();
    await screen.button('Camera', true).click();
    const roll = screen.page.getByRole('spinbutton', { name: 'Roll' });
    await roll.fill('90');
    await change(screen, () => roll.press('Enter'));
    const level = view.project(await lab.value('ball.position'));
    // Roll 90 rotates the image to the left: points right of the centre move above it.
    const there = { x: 320 + (level.y - 240), y: 240 - (level.x - 320) };
    const seen = blue(await screen.pixels());
    t.near(seen.x, there.x, 1.5, 'the image of the ball is rotated, x');
    t.near(seen.y, there.y, 1.5, 'the image of the ball is rotated, y');
    await screen.chooseTool('Object');
    await screen.clickPixel(Math.floor(there.x), Math.floor(there.y));
    await screen.page.getByRole('heading', { name: 'ball', exact: true }).waitFor();
    await change(screen, async () => {
      await screen.drag(there, { x: there.x + 60, y: there.y });
      await screen.quiet();
    });
    const moved = blue(await screen.pixels());
    t.near(moved.x - seen.x, 60, 8, 'a drag to the right moves the image to the right, x');
    t.near(moved.y - seen.y, 0, 8, 'a drag to the right moves the image to the right, y');
  },

  'objects are added, copied, renamed, given a material and removed': async (t) => {
    const lab = await t.lab('tests/shadow.yaml');
    const screen = await t.open(lab);
    await screen.showPanel('Objects');
    const first = await names(lab);
    const added = ['Box', 'Sphere', 'Cylinder', 'Cup', 'Plane', 'Torus', 'Cone', 'Prism', 'Lens', 'Mesh', 'Light'];
    added.push('Material');
    const others = screen.page.locator('details', { hasText: 'Other shapes, lights and files' });
    await others.locator('summary').click();
    for (const shape of added) {
      const known = await names(lab);
      const { trouble } = await change(screen, () => others.getByRole('button', { name: shape, exact: true }).click());
      t.more((await names(lab)).length, known.length, `${shape}: number of objects`);
      t.equal(trouble, null, `${shape}: error of the scene`);
    }
    while (await screen.button('Undo').isEnabled()) await change(screen, () => screen.button('Undo').click());
    t.equal(await names(lab), first, 'the objects after undoing everything');
    await screen.page.getByRole('button', { name: /^ball/ }).click();
    await change(screen, () => screen.button('Copy', true).click());
    const [copy] = (await names(lab)).filter((name) => !first.includes(name));
    t.check(copy, 'the copy has a name');
    const name = screen.page.getByRole('textbox', { name: 'Name' });
    await name.fill('twin');
    await change(screen, () => name.press('Enter'));
    t.check((await names(lab)).includes('twin'), 'the copy is renamed');
    await change(screen, () => screen.page.getByRole('combobox', { name: 'Material' }).selectOption('grey'));
    t.equal(
      (await lab.get('/api/scene')).objects.find((object) => object.name === 'twin').material,
      'grey',
      'the material of the copy',
    );
    await t.axe(screen, 'an object that is chosen');
    await change(screen, () => screen.button('Remove').click());
    t.equal(await names(lab), first, 'the objects after removing the copy');
  },

  'a new scene': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    await screen.showPanel('Objects');
    const state = await change(screen, () => screen.button('New', true).click());
    t.equal(state.file, null, 'the file of a new scene');
    t.equal(state.trouble, null, 'the error of a new scene');
    await change(screen, () => screen.button('Undo').click());
    t.check((await names(lab)).includes('rod'), 'undo restores the previous scene');
  },
};
