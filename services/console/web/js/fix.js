// A position that somebody tells: where the vehicle was, how well that is known, and how long ago it was.
import {ask, order} from "./orders.js";

const kDigits = 7; // a centimetre

export async function tellFix(lat, lon) {
  const values = await ask(
    "Fix",
    "Where the vehicle was. Navigation judges it as any other measurement; a wrong one is refused.",
    "Tell",
    [
      ["Latitude [deg]", "lat_deg", lat.toFixed(kDigits)],
      ["Longitude [deg]", "lon_deg", lon.toFixed(kDigits)],
      ["1 sigma [m]", "sigma_m", 20],
      ["Minutes ago", "minutes", 0],
    ],
  );
  if (!values) return false;
  const {minutes, ...position} = values;
  return order({kind: "fix", ...position, age_s: 60 * minutes});
}
