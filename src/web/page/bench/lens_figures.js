/* The tables and figures of a report on a lens (GET /api/lens).
 * exports:
 *   one(report, section) -> {QUANTITY: number}      of a section with a single record
 *   records(report, section) -> [{KEY: number}]     of another one; NaN: no value
 *   wavelengths(report) -> [nm]                     of its fans, in rising order
 *   lensGroups(report, nm) -> [node]                nm: only this wavelength; 0: all */

import { say } from '../shared/language.js';
import { plot } from '../shared/plot.js';
import { digits, element, facts, group, table } from '../shared/ui.js';

const WIDTH = 300;
const HEIGHT = 250;
const SQUARE = 280; /* a height with which the area of a drawing is square */
const SHOWN = 9; /* digits in tables */
const PLANES = ['fan-tangential', 'fan-sagittal'];

const numberOf = (value) => value ?? NaN;

export const one = (report, section) => report.sections[section]?.values ?? {};

export function records(report, section) {
  const columns = Object.entries(report.sections[section]?.values ?? {});
  return (columns[0]?.[1] ?? []).map((_, i) =>
    Object.fromEntries(columns.map(([key, all]) => [key, numberOf(all[i])])),
  );
}

const distinct = (values) => [...new Set(values)];

export const wavelengths = (report) =>
  distinct(records(report, PLANES[0]).map((row) => row.lambda_nm)).sort((a, b) => a - b);

/* Blue, green, red as far as the colours of charts go. */
function colourOf(all, nm) {
  const at = all.indexOf(nm);
  if (all.length > 3) return at;
  return { 1: [0], 2: [2, 1], 3: [2, 0, 1] }[all.length][at];
}

/* --- names --- */

const NAMES = {
  efl: 'Focal length',
  bfl: 'Back focal length',
  ffl: 'Front focal length',
  z_principal: 'Front principal plane, z',
  z_principal_rear: 'Rear principal plane, z',
  z_nodal: 'Front nodal point, z',
  z_nodal_rear: 'Rear nodal point, z',
  z_focus_front: 'Front focus, z',
  z_focus_rear: 'Rear focus, z',
  stop: 'Stop, surface',
  stop_diameter_real: 'Stop diameter by a real ray',
  z_entrance_pupil: 'Entrance pupil, z',
  entrance_pupil: 'Entrance pupil, diameter',
  z_exit_pupil: 'Exit pupil, z',
  exit_pupil: 'Exit pupil, diameter',
  f_number: 'f-number',
  working_f_number: 'Working f-number',
  z_paraxial_image: 'Paraxial image, z',
  z_image: 'Image plane, z',
  lambda: 'Primary wavelength',
};
const nameOf = (quantity) => NAMES[quantity] ?? quantity[0].toUpperCase() + quantity.slice(1).replaceAll('_', ' ');

const fieldsOf = (report) => {
  const unit = report.sections.fields.units.field_y === 'deg' ? '°' : ' mm';
  return records(report, 'fields').map(({ field, field_x: x, field_y: y }) => ({
    field,
    label: say('Field {field}: {place}', { field, place: `${digits(x === 0 ? y : Math.hypot(x, y), 5)}${unit}` }),
  }));
};

/* --- parts --- */

const meaning = (report, section) =>
  element('p', { class: 'hint', text: `${nameOf(report.sections[section].meaning)}.` });

const key = (entries) =>
  element(
    'p',
    { class: 'lens-key' },
    entries.map(([text, kind]) => element('span', { class: `lens-key-entry ${kind}`, text })),
  );

const keyOfWaves = (all, nm) =>
  all
    .filter((each) => !nm || each === nm)
    .map((each) => [`${digits(each, 7)} nm`, `plot-colour-${colourOf(all, each) + 1}`]);

const row = (...plots) => element('div', { class: 'lens-plots' }, plots);
const wideRow = (...plots) => element('div', { class: 'lens-plots large' }, plots);

const points = (rows, quantity, along = 'x') => rows.map((each) => ({ x: each[along], y: each[quantity] }));

const curve = (name, list, { colour, dash = 0, ...more } = {}) => ({
  name,
  points: list,
  marked: false,
  colour,
  dash,
  ...more,
});

/* The same ends for several drawings: about 0, and never narrower than rounding errors. */
function endsOf(values) {
  const most = Math.max(1e-9, ...values.filter(Number.isFinite).map(Math.abs));
  return [-1.05 * most, 1.05 * most];
}

const drawing = (title, y, series, more) =>
  plot({ title, y, series, width: WIDTH, height: HEIGHT, legends: false, ...more });

/* --- groups --- */

function firstOrder(report) {
  const { units } = report.sections['first-order'];
  return group(
    'First order',
    { id: 'lens.first' },
    meaning(report, 'first-order'),
    element(
      'div',
      { class: 'lens-first' },
      facts(
        Object.entries(one(report, 'first-order')).map(([quantity, value]) => [
          nameOf(quantity),
          `${digits(value, SHOWN)} ${units[quantity]}`,
        ]),
      ),
    ),
  );
}

function spotTable(report, nm) {
  const labels = fieldsOf(report);
  const many = wavelengths(report).length > 1;
  const same = (a, b) => a.field === b.field && a.lambda_nm === b.lambda_nm;
  const waves = records(report, 'wavefront');
  const passing = records(report, 'vignetting');
  const value = (list, spot, quantity) => digits(numberOf(list.find((each) => same(each, spot))?.[quantity]), 6);
  return table({
    caption: 'Spots and wavefronts by field and wavelength',
    columns: [
      'Field',
      'nm',
      { label: 'RMS, mm', title: 'about the centroid' },
      { label: 'Largest, mm', title: 'largest distance from the centroid' },
      { label: 'Airy radius, mm' },
      { label: 'OPD RMS, waves' },
      { label: 'Strehl', title: 'by the peak of the point image, with diffraction' },
      { label: 'Passes', title: "the part of the stop's rays that arrives" },
    ].map((column, at) => ({ ...(column.label ? column : { label: column }), numeric: at > 0 })),
    rows: records(report, 'spot')
      .filter((spot) => (nm ? spot.lambda_nm === nm : many || spot.lambda_nm))
      .map((spot) => [
        labels[spot.field - 1].label,
        spot.lambda_nm ? digits(spot.lambda_nm, 7) : 'all',
        digits(spot.rms_centroid, SHOWN),
        digits(spot.geo, SHOWN),
        digits(spot.airy_radius, 6),
        value(waves, spot, 'rms'),
        value(waves, spot, 'strehl_diffraction'),
        value(passing, spot, 'passes'),
      ]),
  });
}

function spots(report, nm) {
  const all = wavelengths(report);
  const list = records(report, 'spot');
  const dots = records(report, 'spot-points').filter((each) => !nm || each.lambda_nm === nm);
  const airy = numberOf(list.find((each) => each.lambda_nm === nm)?.airy_radius); /* 0: of the primary one */
  const ends = endsOf([airy, ...dots.flatMap(({ dx, dy }) => [dx, dy])]);
  const ofField = ({ field, label }) =>
    drawing(
      label,
      { label: 'mm from the chief ray', ends },
      all.map((each) =>
        curve(
          `${digits(each, 7)} nm`,
          dots.filter((dot) => dot.field === field && dot.lambda_nm === each).map(({ dx, dy }) => ({ x: dx, y: dy })),
          {
            shape: 'dots',
            colour: colourOf(all, each),
          },
        ),
      ),
      {
        height: SQUARE,
        x: { label: 'mm', ends },
        circles: [
          { x: 0, y: 0, r: airy, text: say("Airy's first dark ring, radius {radius} mm", { radius: digits(airy) }) },
        ],
      },
    );
  return group(
    'Spots',
    { id: 'lens.spots', hint: 'by field and wavelength' },
    key([...keyOfWaves(all, nm), [say('Airy circle, radius {radius} mm', { radius: digits(airy) }), 'circle']]),
    row(...fieldsOf(report).map(ofField)),
    spotTable(report, nm),
  );
}

function fans(report, nm, { id, title, quantities, label }) {
  const all = wavelengths(report);
  const planes = PLANES.map((section) => records(report, section).filter((each) => !nm || each.lambda_nm === nm));
  const ends = endsOf(planes.flatMap((list, plane) => list.map((each) => each[quantities[plane]])));
  const ofField = (field) =>
    planes.flatMap((list, plane) =>
      all.map((each) =>
        curve(
          `${[say('tangential'), say('sagittal')][plane]}, ${digits(each, 7)} nm`,
          points(
            list.filter((one) => one.field === field && one.lambda_nm === each),
            quantities[plane],
          ),
          { colour: colourOf(all, each), dash: plane },
        ),
      ),
    );
  return group(
    title,
    { id, hint: 'by height in the pupil' },
    key([...keyOfWaves(all, nm), ['tangential', 'line'], ['sagittal', 'dashed']]),
    row(
      ...fieldsOf(report).map(({ field, label: name }) =>
        drawing(`${name}`, { label, ends }, ofField(field), { x: { label: 'pupil', ends: [-1, 1] }, mark: 0 }),
      ),
    ),
  );
}

function alongField(report, nm) {
  const all = wavelengths(report);
  const foci = records(report, 'field-curves');
  const axial = records(report, 'longitudinal').filter((each) => !nm || each.lambda_nm === nm);
  const unit = report.sections.fields.units.field_y === 'deg' ? 'field, °' : 'field, mm';
  const drawings = [
    drawing(
      'Field curves',
      { label: 'mm from the image' },
      ['tangential', 'sagittal'].map((name, at) => curve(name, points(foci, name), { colour: 0, dash: at })),
      { x: { label: unit }, mark: 0 },
    ),
    drawing('Distortion', { label: '%' }, [curve('distortion', points(foci, 'distortion'), { colour: 0 })], {
      x: { label: unit },
      mark: 0,
    }),
    drawing(
      'Focus of the axial beam',
      { label: 'mm from the image' },
      all.map((each) =>
        curve(
          `${digits(each, 7)} nm`,
          points(
            axial.filter((point) => point.lambda_nm === each),
            'focus',
          ),
          {
            colour: colourOf(all, each),
          },
        ),
      ),
      { x: { label: 'height in the pupil', ends: [0, 1] }, mark: 0 },
    ),
  ];
  const shown = foci.length > 1 ? drawings : drawings.slice(2);
  return group(
    'Field curves, distortion, axial colour',
    { id: 'lens.field' },
    key([...keyOfWaves(all, nm), ['tangential', 'line'], ['sagittal', 'dashed']]),
    row(...shown),
  );
}

function mtf(report) {
  const fields = fieldsOf(report);
  const kinds = [
    ['mtf-diffraction', 'MTF with diffraction'],
    ['mtf-geometric', 'MTF of the spots, without diffraction'],
  ].filter(([section]) => report.sections[section]);
  const curves = (list) =>
    fields.flatMap(({ field, label }, at) =>
      ['tangential', 'sagittal'].map((name, dash) =>
        curve(
          `${label}, ${name}`,
          points(
            list.filter((each) => each.field === field),
            name,
          ),
          { colour: at, dash },
        ),
      ),
    );
  const limit = (list) =>
    list[0]?.limit === undefined
      ? []
      : [
          curve(
            'limit of a round pupil',
            points(
              list.filter((each) => each.field === fields[0].field),
              'limit',
            ),
            {
              colour: 3,
              dash: 2,
            },
          ),
        ];
  return group(
    'MTF',
    { id: 'lens.mtf', hint: 'all wavelengths by their weights' },
    key([
      ...fields.map(({ label }, at) => [label, `plot-colour-${(at % 5) + 1}`]),
      ['tangential', 'line'],
      ['sagittal', 'dashed'],
      ['limit of a round pupil', 'plot-colour-4 dotted'],
    ]),
    wideRow(
      ...kinds.map(([section, title]) => {
        const list = records(report, section);
        return drawing(title, { label: 'contrast', ends: [0, 1] }, [...curves(list), ...limit(list)], {
          x: { label: 'cycles/mm' },
          width: 1.5 * WIDTH,
        });
      }),
    ),
  );
}

function seidel(report) {
  const rows = records(report, 'seidel');
  const sum = one(report, 'seidel-sum');
  const sums = ['S_I', 'S_II', 'S_III', 'S_IV', 'S_V'];
  const names = ['I spherical', 'II coma', 'III astigmatism', 'IV Petzval', 'V distortion'];
  const columns = [...sums, 'C_L', 'C_T'];
  return group(
    'Seidel sums',
    { id: 'lens.seidel', hint: 'by surface' },
    meaning(report, 'seidel'),
    key(names.map((name, at) => [name, `plot-colour-${at + 1} block`])),
    plot({
      title: 'Seidel sums by surface',
      width: 700,
      height: 300,
      legends: false,
      mark: 0,
      x: { label: 'surface', values: rows.map(({ surface }) => String(surface)) },
      y: { label: 'mm' },
      series: sums.map((quantity) => ({
        name: quantity,
        shape: 'bars',
        points: rows.map((each, at) => ({ x: at, y: each[quantity] })),
      })),
    }),
    table({
      caption: 'Seidel sums by surface, mm',
      columns: ['Surface', ...columns.map((label) => ({ label: label.replace('_', ' '), numeric: true }))],
      rows: [
        ...rows.map((each) => [String(each.surface), ...columns.map((quantity) => digits(each[quantity], 6))]),
        ['Sum', ...columns.map((quantity) => digits(sum[quantity], 6))],
      ],
    }),
  );
}

export const lensGroups = (report, nm) => [
  firstOrder(report),
  spots(report, nm),
  fans(report, nm, {
    id: 'lens.fans',
    title: 'Ray fans',
    quantities: ['e_tangential', 'e_sagittal'],
    label: 'mm from the chief ray',
  }),
  fans(report, nm, { id: 'lens.waves', title: 'Wavefronts', quantities: ['opd', 'opd'], label: 'waves' }),
  alongField(report, nm),
  mtf(report),
  seidel(report),
];
