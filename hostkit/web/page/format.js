// Numbers as text. What is not known is a dash.

const DASH = "–";
const MINUS = "\u2212";
const known = (value) => typeof value === "number" && Number.isFinite(value);
const signed = (said) => said.replace("-", MINUS);

export function fixed(value, digits) {
  if (!known(value)) return DASH;
  const said = value.toFixed(digits);
  return Number(said) === 0 ? said.replace("-", "") : signed(said);
}

/** An angle with a sign always, so that digits do not jump. */
export function angle(value, digits = 2) {
  if (!known(value)) return DASH;
  const said = Math.abs(value).toFixed(digits);
  return (value < 0 && Number(said) !== 0 ? MINUS : "+") + said;
}

/** Three or so significant digits, without an exponent where that is readable. */
export function figure(value, digits = 4) {
  if (!known(value)) return DASH;
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-4 || size >= 1e7)) return signed(value.toExponential(2));
  return signed(String(Number(value.toPrecision(digits))));
}

export function degrees(value) {
  if (!known(value)) return DASH;
  const size = Math.abs(value);
  const digits = size >= 10 ? 1 : size >= 1 ? 2 : size >= 0.1 ? 3 : size >= 0.001 ? 4 : 5;
  return fixed(value, digits);
}

export function count(value) {
  if (!known(value)) return DASH;
  return Math.round(value).toLocaleString("en").replaceAll(",", "\u202f");
}

export function bytes(value) {
  if (!known(value)) return DASH;
  if (value < 1000) return `${value} B`;
  if (value < 1e6) return `${(value / 1e3).toFixed(1)} kB`;
  return `${(value / 1e6).toFixed(1)} MB`;
}

export function clock(seconds) {
  if (!known(seconds)) return DASH;
  const whole = Math.max(0, Math.floor(seconds));
  const minutes = Math.floor(whole / 60);
  const tail = String(whole % 60).padStart(2, "0");
  if (minutes < 60) return `${minutes}:${tail}`;
  return `${Math.floor(minutes / 60)}:${String(minutes % 60).padStart(2, "0")}:${tail}`;
}

export function timeOfDay(epochSeconds) {
  if (!known(epochSeconds)) return "";
  const date = new Date(epochSeconds * 1000);
  return Number.isNaN(date.getTime()) ? "" : date.toTimeString().slice(0, 8);
}

export function withUnit(said, unit) {
  return said === DASH || !unit ? said : `${said}\u202f${unit}`;
}
