// How things look on the map, said once for the chart and its legend. Shape and dash say what colour says as well.

/** The track, by what navigation rested on. */
export const kTracks = {
  gps_aided: {ink: "s3", dash: [], words: "GPS aided"},
  acoustic_aided: {ink: "s2", dash: [12, 4], words: "acoustic aided"},
  dead_reckoning: {ink: "s1", dash: [6, 4], words: "dead reckoning"},
  inertial: {ink: "bad", dash: [2, 3], words: "inertial"},
};
export const kOtherTrack = {ink: "soft", dash: [1, 4], words: "not aligned"};
export const trackLook = (name) => kTracks[name] ?? kOtherTrack;

export const fixInk = (source) => ({usbl: "s2", fix: "s4"})[source] ?? "s3";
