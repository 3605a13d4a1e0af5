/* A pixel's ray tree from /api/trace as a list, and the texts for each ray. Pure functions without page and server.
 *
 * exports:
 *   buildTree(answer) -> {answer, rays, roots, reach}
 *     rays in table order; each {index, node, parent, level, children, weight, line}; weight: 0..1 of the camera ray's;
 *     line: of ray_line.js, of a ray that was cut off a short stub; reach: extent of the hits
 *   isCut(ray)                                       whether it was cut off by depth or weight
 *   lineClass(ray)                                   the class of its line in a drawing
 *   kinds                                            [class, description] of each, for legends
 *   columns, describe(ray)                           [key, head, title] of the table's columns, and the texts of a
 *   row */

import { digits } from './ui.js';
import { lineTo } from './ray_line.js';
import { length, mean } from './ray_vectors.js';

const CUT = 0.15; /* the stub of a ray that was cut off, by the extent of the hits */

export const kinds = [
  ['ray-camera', 'camera ray'],
  ['ray-reflect', 'reflected'],
  ['ray-refract', 'refracted'],
  ['ray-shadow', 'to a light'],
  ['ray-blocked', 'shadow ray, blocked'],
  ['ray-cut', 'cut off'],
];

const kindWords = { camera: 'camera ray', reflect: 'reflected', refract: 'refracted', shadow: 'to a light' };

const endWords = {
  hit: 'hits a surface',
  sky: 'background',
  cut_depth: 'cut off: depth limit',
  cut_weight: 'cut off: weight too small',
  lit: 'unoccluded',
  blocked: 'blocked',
};

export const isCut = ({ node }) => node.end === 'cut_depth' || node.end === 'cut_weight';

export function lineClass(ray) {
  if (isCut(ray)) return 'ray ray-cut';
  return ray.node.end === 'blocked' ? 'ray ray-blocked' : `ray ray-${ray.node.kind}`;
}

export function buildTree(answer) {
  const first = answer.roots || [answer.root];
  const all = mean(first[0].throughput) || 1;
  const rays = [];
  const visit = (node, parent, level) => {
    const ray = { index: rays.length, node, parent, level, children: [] };
    /* A shadow ray's throughput is a radiance, so it gets the weight of its parent ray. */
    ray.weight = node.kind === 'shadow' && parent ? parent.weight : Math.min(1, mean(node.throughput) / all);
    rays.push(ray);
    ray.children = node.children.map((child) => visit(child, ray, level + 1));
    return ray;
  };
  const roots = first.map((node) => visit(node, null, 1));
  const reach = extent(rays);
  for (const ray of rays) {
    const { origin: from, direction, far_end: farEnd } = ray.node;
    ray.line = isCut(ray) ? { from, along: direction, end: CUT * reach } : lineTo(from, farEnd);
  }
  return { answer, rays, roots, reach };
}

/* The extent of the hits; for a single hit, a part of its distance. */
function extent(rays) {
  const hits = rays.filter((ray) => ray.node.hit).map((ray) => ray.node.hit);
  if (!hits.length) return 1;
  const sides = [0, 1, 2].map((k) => {
    let low = Infinity;
    let high = -Infinity;
    for (const { point } of hits) {
      low = Math.min(low, point[k]);
      high = Math.max(high, point[k]);
    }
    return high - low;
  });
  return Math.max(length(sides), 0.25 * hits[0].t);
}

/* --- texts --- */

export const columns = [
  ['kind', 'Ray', 'origin of the ray'],
  ['media', 'Media', 'on both sides of the surface, with refractive indices'],
  ['angles', 'Angles', 'angles of incidence and refraction, from the normal'],
  ['reflectance', 'R', 'reflectance of unpolarised light'],
  ['transmitted', 'T', 'transmittance of the surface'],
  ['polarised', 'R_s, R_p', 'reflectance of each polarisation'],
  ['surface', 'Hits', 'solid and surface'],
  ['depth', 'Depth', 'number of reflections and refractions since the camera'],
  ['path', 'Path', 'length of the ray up to the hit'],
  [
    'transmittance',
    'Transmittance',
    'share of the light that the medium does not absorb on the path; red, green, blue where they differ',
  ],
  ['weight', 'Weight', "share of the ray's light in the pixel"],
  ['brought', 'Contribution', 'radiance that this ray itself adds to the pixel'],
  ['end', 'End', 'how the ray ends'],
];

const share = (value) => `${digits(100 * value, 3)} %`;
const degrees = (angle) => `${digits(angle, 4)}°`;

/* One number if the channels are equal, otherwise three. */
const channels = (c) => (c[0] === c[1] && c[1] === c[2] ? digits(c[0], 3) : c.map((x) => digits(x, 3)).join(' · '));

const medium = ({ medium: name, n }) => (name === digits(n) ? name : `${name} ${digits(n)}`);

function surface(hit) {
  return hit.surface_of ? `${hit.solid}: ${hit.surface} of ${hit.surface_of}` : `${hit.solid}: ${hit.surface}`;
}

function angles({ opaque, tir, snell }) {
  const incidence = degrees(snell.incidence_deg);
  if (opaque) return incidence;
  return tir ? `${incidence}, no refraction` : `${incidence} → ${degrees(snell.refraction_deg)}`;
}

function reflectance(hit) {
  if (hit.tir) return 'total reflection';
  if (hit.opaque) return hit.R > 0 ? `${share(hit.R)}, opaque` : 'opaque';
  return share(hit.R);
}

function ofHit(hit) {
  return {
    surface: surface(hit),
    media: hit.opaque ? `in ${medium(hit.from)}` : `${medium(hit.from)} → ${medium(hit.to)}`,
    angles: angles(hit),
    reflectance: reflectance(hit),
    transmitted: hit.opaque || hit.tir ? '' : share(hit.T),
    polarised: hit.opaque || hit.tir ? '' : `${share(hit.R_s)}, ${share(hit.R_p)}`,
    path: `${digits(hit.path_length)} m`,
    transmittance: channels(hit.transmittance),
  };
}

export function describe(ray) {
  const { node } = ray;
  return {
    kind: node.kind === 'shadow' && node.light ? `to ${node.light}` : kindWords[node.kind],
    depth: String(node.depth),
    surface: '',
    media: `in ${medium(node)}`,
    angles: '',
    reflectance: '',
    transmitted: '',
    polarised: '',
    path: '',
    transmittance: '',
    weight: channels(node.throughput),
    brought: node.brought.some((x) => x !== 0) ? channels(node.brought) : '',
    end: endWords[node.end] || node.end,
    ...(node.hit ? ofHit(node.hit) : {}),
  };
}
