// Where things lie: flat earth around an origin, for display. Nothing here knows a browser.

const kEarthM = 6371000;
const kPoints = 180; // of a ring: a wide one has no corners
const kK95 = 2.4477; // of two dimensions, 95 %

/** Metres north and east of an origin, and back. Places are {lat, lng} in degrees. */
export const metresOf = (origin, {lat, lng}) => ({
  north: ((lat - origin.lat) * Math.PI * kEarthM) / 180,
  east: ((lng - origin.lng) * Math.PI * kEarthM * Math.cos((origin.lat * Math.PI) / 180)) / 180,
});
export const degreesOf = (origin, {north, east}) => ({
  lat: origin.lat + (north / kEarthM) * (180 / Math.PI),
  lng: origin.lng + (east / (kEarthM * Math.cos((origin.lat * Math.PI) / 180))) * (180 / Math.PI),
});

/** The points of an ellipse around the origin, as offsets in metres; `turn`: of the major axis from north. */
function ring(major, minor, turn) {
  return Array.from({length: kPoints + 1}, (_, i) => {
    const angle = (i / kPoints) * 2 * Math.PI;
    const [along, across] = [major * Math.cos(angle), minor * Math.sin(angle)];
    return {
      north: along * Math.cos(turn) - across * Math.sin(turn),
      east: along * Math.sin(turn) + across * Math.cos(turn),
    };
  });
}

/** The 95 % ellipse of a horizontal covariance [nn, ne, ee]. */
export function ellipse([nn, ne, ee]) {
  const mean = (nn + ee) / 2;
  const split = Math.hypot((nn - ee) / 2, ne);
  const major = Math.sqrt(Math.max(0, mean + split)) * kK95;
  const minor = Math.sqrt(Math.max(0, mean - split)) * kK95;
  return ring(major, minor, 0.5 * Math.atan2(2 * ne, nn - ee));
}

export const circle = (radius) => ring(radius, radius, 0);

/** How far a slant range reaches on the map; the slant range itself where a depth is unknown. */
export function horizontalRange(range, beaconDepth, vehicleDepth) {
  const apart = beaconDepth - vehicleDepth;
  if (beaconDepth === null || !Number.isFinite(apart)) return range;
  return Math.sqrt(Math.max(0, range * range - apart * apart));
}

/** A track as runs of one mode: [{mode, from, to}], rows from ≤ i ≤ to. Neighbours share a row; gaps belong to nobody. */
export function runsOf(lat, modes) {
  const runs = [];
  let run = null;
  for (let i = 0; i < lat.length; ++i) {
    if (lat[i] === null) {
      run = null;
      continue;
    }
    const mode = modes[i] ?? null;
    if (run && run.mode === mode) {
      run.to = i;
      continue;
    }
    if (run) run.to = i; // a line without a hole where the mode changes
    run = {mode, from: i, to: i};
    runs.push(run);
  }
  return runs;
}
