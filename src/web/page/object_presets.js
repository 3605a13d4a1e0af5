/* Media for new and existing solids, by everyday names. The indices are those of the program's catalogue (cuvette
 * media); the highlight is that of the clear media of rod.yaml.
 * exports: presetChoices(lab) -> [[word, label], ..], for solids: '' is a painted surface, other words are media and
 *          the scene's own materials; presetValues(word) -> {ROW: VALUE} for POST /api/objects */

const CLEAR = {
  transparency: 1,
  color: [1, 1, 1],
  ambient: 0,
  diffuse: 0,
  reflectivity: 0,
  specular: 0.6,
  shininess: 80,
  absorb_per_m: [0, 0, 0],
};

/* Absorption of pure water at 640, 550 and 460 nm: Pope and Fry, Appl. Opt. 36, 8710 (1997). */
const MEDIA = {
  glass: { label: 'Glass (BK7)', values: { ...CLEAR, medium: 'bk7' } },
  water: { label: 'Water', values: { ...CLEAR, medium: 'water', absorb_per_m: [0.3108, 0.0565, 0.00979] } },
  oil: { label: 'Olive oil', values: { ...CLEAR, medium: 'olive-oil' } },
  acrylic: { label: 'Acrylic glass', values: { ...CLEAR, medium: 'pmma' } },
  diamond: { label: 'Diamond', values: { ...CLEAR, medium: 'diamond' } },
};

const OF_SCENE = 'material ';

export function presetChoices(lab) {
  const own = (lab.scene?.objects || []).filter((object) => object.kind === 'material');
  return [
    ['', 'Paint'],
    ...Object.entries(MEDIA).map(([word, { label }]) => [word, label]),
    ...own.map(({ name }) => [OF_SCENE + name, `Material ${name}`]),
  ];
}

export function presetValues(word) {
  if (word.startsWith(OF_SCENE)) return { material: word.slice(OF_SCENE.length) };
  return MEDIA[word]?.values || {};
}

export const mediaChoices = () => Object.entries(MEDIA).map(([word, { label }]) => [word, label]);
