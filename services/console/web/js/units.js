// Numbers as people read them. SI and degrees come in; the chosen units go out.
import {prefs} from "./prefs.js";

const kFoot = 0.3048;
const kKnot = 1852 / 3600;
const none = "–";
const known = (value) => typeof value === "number" && Number.isFinite(value);

export const lengthUnit = () => prefs.length;
export const speedUnit = () => prefs.speed;
export const toLength = (metres) => (prefs.length === "ft" ? metres / kFoot : metres);
export const toSpeed = (mPerS) => (prefs.speed === "kn" ? mPerS / kKnot : mPerS);

export const fixed = (value, digits = 1) =>
  known(value) ? value.toFixed(digits).replace(/^-(0(\.0+)?)$/, "$1") : none;
export const length = (metres, digits = 1) =>
  known(metres) ? `${fixed(toLength(metres), digits)} ${prefs.length}` : none;
export const speed = (mPerS, digits = 2) => (known(mPerS) ? `${fixed(toSpeed(mPerS), digits)} ${prefs.speed}` : none);
export const degrees = (value, digits = 1) => (known(value) ? `${fixed(value, digits)}°` : none);
export const bearing = (value) => {
  if (!known(value)) return none;
  const turned = ((value % 360) + 360) % 360;
  return `${(turned >= 359.95 ? 0 : turned).toFixed(1).padStart(5, "0")}°`;
};

function sexagesimal(value, positive, negative) {
  const tenths = Math.round(Math.abs(value) * 36000); // of a second of arc: 3 m
  const hundredths = Math.round(Math.abs(value) * 360000);
  const seconds = hundredths / 100;
  const whole = Math.floor(seconds / 3600);
  const minutes = Math.floor((seconds - whole * 3600) / 60);
  const rest = (seconds - whole * 3600 - minutes * 60).toFixed(2).padStart(5, "0");
  return tenths === 0
    ? `0° 00′ 00.00″ ${positive}`
    : `${whole}° ${String(minutes).padStart(2, "0")}′ ${rest}″ ${value < 0 ? negative : positive}`;
}

export const latitude = (value) =>
  !known(value) ? none : prefs.angle === "dms" ? sexagesimal(value, "N", "S") : `${value.toFixed(6)}°`;
export const longitude = (value) =>
  !known(value) ? none : prefs.angle === "dms" ? sexagesimal(value, "E", "W") : `${value.toFixed(6)}°`;

/** "12.3 s", "4 min 05 s", "2 h 03 min": the words of the service's own sentences. */
export function duration(seconds) {
  if (!known(seconds)) return none;
  if (seconds < 100) return `${seconds.toFixed(1)} s`;
  const whole = Math.floor(seconds);
  const two = (n) => String(n).padStart(2, "0");
  if (whole < 3600) return `${Math.floor(whole / 60)} min ${two(whole % 60)} s`;
  return `${Math.floor(whole / 3600)} h ${two(Math.floor((whole % 3600) / 60))} min`;
}

export const clockText = (ms) => new Date(ms).toISOString().slice(11, 19);

/** Seconds from a time of day like "09:05:00" to now, UTC; null where that is none of the last two hours. */
export function secondsSince(text, nowMs) {
  const [, hours, minutes, seconds] = text.trim().match(/^(\d{1,2}):(\d{2}):(\d{2})$/) ?? [];
  if (hours === undefined || hours > 23 || minutes > 59 || seconds > 59) return null;
  const day = 86400;
  const ago = nowMs / 1000 - (hours * 3600 + minutes * 60 + Number(seconds));
  const age = ((ago % day) + day) % day;
  if (age > day - 60) return 0; // clocks of people go a little ahead
  return age <= 7200 ? age : null;
}
export const words = (name) =>
  String(name)
    .replaceAll("_", " ")
    .replace(/\b(gps|dvl|imu|usbl)\b/g, (short) => short.toUpperCase());

/** "gyro_bias_x_rad_s" → {group: "gyro bias", name: "x", unit: "deg/h", scale} : the units that people know. */
export function stateName(raw) {
  const units = [
    ["_rad_s", "deg/h", (180 / Math.PI) * 3600],
    ["_rad", "deg", 180 / Math.PI],
    ["_m_s2", "mm/s²", 1000],
    ["_m_s", "m/s", 1],
    ["_m", "m", 1],
    ["_s", "s", 1],
  ];
  for (const [suffix, unit, scale] of units) {
    if (raw.endsWith(suffix)) return split(raw.slice(0, -suffix.length), unit, scale);
  }
  return split(raw, "‰", 1000); // scale factors have no unit
}

function split(name, unit, scale) {
  const axis = name.match(/^(.*)_(north|east|down|xy|xz|yx|yz|zx|zy|x|y|z|b|c|d|e)$/);
  return axis
    ? {group: words(axis[1]), name: axis[2], unit, scale}
    : {group: words(name), name: words(name), unit, scale};
}
