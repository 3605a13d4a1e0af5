// A ball of slime is let fall, taken hold of in the picture, pulled and let go: it comes back. What is green in the picture is the body.

/** How much wider by its height it is to be while it is pulled. */
const SPREAD = 1.15;
const PICTURE_WIDTH = 480;

function silhouette({ width, height, data }) {
    let [count, left, right, top, bottom] = [0, width, -1, height, -1];
    for (let y = 0; y < height; y++)
        for (let x = 0; x < width; x++) {
            const i = (y * width + x) * 4;
            if (data[i + 1] < 1.3 * data[i] || data[i + 1] < 1.3 * data[i + 2]) continue;
            count++;
            [left, right, top, bottom] = [Math.min(left, x), Math.max(right, x), Math.min(top, y), Math.max(bottom, y)];
        }
    return { count, left, right, top, bottom, wide: right - left, high: bottom - top, middle: (top + bottom) / 2 };
}

const atRest = (screen) => screen.until(() => window.lab.slime?.resting && window.lab.slime.held === 0 && window.lab.picture.final);
const nextPicture = (screen) => screen.page.evaluate(() => new Promise((drawn) => {
    const end = window.lab.on('picture', () => {
        end();
        drawn();
    });
}));

async function fallen(t) {
    const lab = await t.lab('tests/slime.yaml');
    const screen = await t.open(lab, { width: 1920, height: 1080 });
    screen.context.setDefaultTimeout(60000);
    await screen.actualSize();
    await screen.showPanel('Slime');
    await screen.button('Play').click();
    await atRest(screen);
    return { lab, screen, rest: silhouette(await screen.pixels()) };
}

/** It may have rolled nearer or farther and lie on another side, which weighs a little on its shape: less than half of what pulling it did. */
function checkBack(t, before, after, what) {
    t.check(after.left > 0 && after.right < PICTURE_WIDTH - 1, `${what}: it is in the picture`);
    const [was, is] = [before.wide / before.high, after.wide / after.high];
    t.near(is, was, 0.06 * was, `${what}: its width by its height`);
    t.near(after.count / (after.wide * after.high), before.count / (before.wide * before.high), 0.02, `${what}: its share of its frame`);
}

export const cases = {
    'pulled by the mouse': async (t) => {
        const { lab, screen, rest } = await fallen(t);
        t.more(rest.count, 2000, 'the body is in the picture, pixels');
        await screen.chooseTool('Grab');
        const [from, to] = [{ x: rest.right - 20, y: rest.middle }, { x: rest.right + 100, y: rest.middle - 20 }];
        const [a, b] = [await screen.place(from.x, from.y), await screen.place(to.x, to.y)];
        await screen.page.mouse.move(a.x, a.y);
        await screen.page.mouse.down();
        await screen.until(() => window.lab.slime.held > 0);
        t.more((await lab.get('/api/state')).slime.held, 0, 'masses that are held');
        await screen.page.mouse.move(b.x, b.y, { steps: 20 });
        let pulled = silhouette(await screen.pixels());
        while (pulled.right < rest.right + 30 || pulled.wide / pulled.high < SPREAD * rest.wide / rest.high) {
            await nextPicture(screen);
            pulled = silhouette(await screen.pixels());
        }
        t.check(true, 'it was drawn out');
        await t.picture(screen, 'slime');
        await screen.page.mouse.up();
        await screen.until(() => window.lab.slime.held === 0);
        await atRest(screen);
        checkBack(t, rest, silhouette(await screen.pixels()), 'let go');
        const { slime } = await lab.get('/api/state');
        t.near(slime.volume / slime.volume_at_rest, 1, 0.03, 'its volume, of that at rest');
        t.equal(slime.trouble, null, 'it has no trouble');
    },

    'pulled by keys': async (t) => {
        const { screen, rest } = await fallen(t);
        await screen.chooseTool('Grab');
        await screen.stage.focus();
        // The cross begins in the middle of the picture, where the body is.
        await screen.page.keyboard.press('Enter');
        await screen.until(() => window.lab.slime.held > 0);
        for (let i = 0; i < 8; i++) await screen.page.keyboard.press('ArrowLeft');
        let pulled = silhouette(await screen.pixels());
        while (pulled.left > rest.left - 25) {
            await nextPicture(screen);
            pulled = silhouette(await screen.pixels());
        }
        t.check(pulled.left <= rest.left - 25, 'its left edge follows the keys');
        await screen.page.keyboard.press('Enter');
        await screen.until(() => window.lab.slime.held === 0);
        await atRest(screen);
        checkBack(t, rest, silhouette(await screen.pixels()), 'let go');
    },

    'paused, and off': async (t) => {
        const lab = await t.lab('tests/slime.yaml');
        const screen = await t.open(lab);
        await screen.showPanel('Slime');
        await screen.button('Play').click();
        await screen.until(() => window.lab.slime.time_s > 0.2);
        await screen.button('Pause').click();
        await screen.until(() => !window.lab.slime.playing && window.lab.picture.final);
        const { slime, picture } = await lab.get('/api/state');
        const own = JSON.parse(await lab.run('render', 'tests/slime.yaml', '--json')).film_hash;
        t.check(picture.film_hash !== own, 'the picture shows where it is, not where the scene has it');
        const [again] = [(await lab.get('/api/state')).slime];
        t.equal(again.time_s, slime.time_s, 'its time stands still');
        await screen.button('Off').click();
        await screen.until((hash) => window.lab.picture.film_hash === hash, own);
        t.equal((await lab.get('/api/state')).slime.on, false, 'it is off, and the picture is that of cuvette render');
    },

    'a scene without one': async (t) => {
        const lab = await t.lab('scenes/rod.yaml');
        const screen = await t.open(lab);
        await screen.showPanel('Slime');
        await screen.page.getByText('This scene has no slime').waitFor();
        t.equal(await screen.page.getByRole('radio', { name: 'Grab' }).isVisible(), false, 'there is no tool to grab it');
        const { generation } = await lab.get('/api/state');
        await screen.button('Add a slime').click();
        await screen.until((g) => window.lab.wanted > g, generation);
        await screen.settled(generation + 1);
        await screen.button('Play').waitFor();
        t.check(await screen.page.getByRole('radiogroup', { name: 'What the pointer does' }).getByText('Grab').isVisible(), 'one that was added can be grabbed');
    },
};
