/* Everyday words for parameters, for the search of the panel Parameters: a search for the word on the left also finds
 * the rows whose path or description contains one of those on the right. Add a word here if a search for it finds
 * nothing, or misses what a newcomer means. The words of a choice (a medium, an integrator) are found without this
 * table. exports: meaningsOf(word) -> [words], the word itself first; words that begin like a key count for it */

const SYNONYMS = {
  air: ['background.ior', 'background.medium', 'background.absorb'],
  angle: ['rotation', 'yaw', 'pitch', 'roll', 'half_angle', 'fov'],
  antialiasing: ['render.samples', 'render.filter', 'render.paths'],
  birefringent: ['extraordinary', 'optic_axis', 'birefringence'],
  blur: ['render.filter', 'shininess', 'roughness'],
  bounces: ['render.depth'],
  brightness: ['intensity', 'emission', 'ambient', 'background.color'],
  bubble: ['film_thickness', 'film_ior'],
  calcite: ['extraordinary', 'optic_axis'],
  caustics: ['render.integrator', 'render.shadows'],
  colour: ['color', 'absorb', 'tint'],
  cores: ['render.threads'],
  crystal: ['extraordinary', 'optic_axis', 'medium'],
  dark: ['intensity', 'ambient', 'render.depth'],
  dispersion: ['medium', 'coefficients', 'render.spectrum', 'render.wavelengths'],
  environment: ['background'],
  exposure: ['intensity', 'emission'],
  fresnel: ['render.weights'],
  fog: ['scatter', 'asymmetry'],
  frosted: ['roughness'],
  glass: ['medium', 'ior', 'transparency'],
  glow: ['emission'],
  index: ['ior', 'medium', 'coefficients'],
  lens: ['fov', 'ior'],
  liquid: ['medium', 'ior', 'transparency', 'absorb'],
  magnification: ['fov'],
  metal: ['medium', 'extinction'],
  mirror: ['reflectivity', 'ior'],
  milk: ['scatter', 'asymmetry'],
  murky: ['absorb', 'tint', 'scatter'],
  noise: ['render.paths', 'render.samples', 'render.error', 'render.sampler'],
  oil: ['medium', 'ior', 'transparency', 'absorb', 'film_thickness'],
  opacity: ['transparency'],
  place: ['position'],
  plate: ['sheet', 'retardance', 'birefringence'],
  polarizer: ['sheet', 'render.polarisation', 'camera.analyser'],
  polaroid: ['sheet', 'render.polarisation', 'camera.analyser'],
  prism: ['medium', 'coefficients', 'render.spectrum', 'sides'],
  quality: ['render.samples', 'render.depth', 'render.paths', 'render.width', 'render.height'],
  rainbow: ['background.kind', 'background.rain', 'background.drops', 'render.spectrum', 'medium'],
  reflection: ['reflectivity', 'render.depth', 'render.weights', 'specular'],
  refraction: ['ior', 'medium', 'transparency', 'render.transmission'],
  resolution: ['render.width', 'render.height'],
  shiny: ['specular', 'shininess', 'reflectivity'],
  sky: ['background', 'background.sky_type'],
  smooth: ['shading', 'render.samples', 'shininess', 'roughness'],
  soap: ['film_thickness', 'film_ior'],
  speed: ['render.threads', 'render.accel', 'render.samples', 'render.depth'],
  sun: ['background.sun', 'light.position', 'light.angular_diameter'],
  transparent: ['transparency'],
  waveplate: ['sheet', 'retardance', 'birefringence'],
  water: ['medium', 'ior', 'transparency', 'absorb'],
  zoom: ['fov', 'camera.position', 'scale'],
};

const LEAST = 3; /* letters of a beginning: 'brigh' finds what 'brightness' does */

export function meaningsOf(word) {
  const keys = Object.keys(SYNONYMS).filter(
    (key) => key === word || (word.length >= LEAST && (key.startsWith(word) || word === `${key}s`)),
  );
  return [word, ...keys.flatMap((key) => SYNONYMS[key])];
}
