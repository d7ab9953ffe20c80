"""A vehicle drawn by seed: the scenario that the simulator runs, and what is true of it."""
import random

import turns

# What the simulator speaks, by kind: protocols and rates, Hz.
SPOKEN = {
    "imu": (["vectornav"], [50, 100, 200]),
    "gps": (["nmea0183", "ubx"], [2, 4, 5, 10]),
    "dvl": (["pd0", "waterlinked"], [4, 5, 8]),
    "depth": (["paroscientific", "ascii_depth"], [5, 10, 20]),
    "heading": (["nmea0183"], [5, 10, 20]),
    "usbl": (["psimssb"], [0.5, 1]),
    "altimeter": (["nmea0183"], [2, 5]),
    "range": (["micromodem"], [0.5]),
    "airspeed": (["ascii_air_data", "nmea_air_data"], [5, 10]),
    "propulsion": (["nmea0183"], [5, 10]),
}
ALWAYS = ["imu", "gps", "dvl", "depth", "heading"]
LATE_S = {"gps": (-0.1, 0.2), "dvl": (-0.1, 0.3), "depth": (-0.05, 0.15), "heading": (-0.1, 0.2)}


def mission(draw, rest_s, legs):
    """Rest; circles to both sides at the surface; dives with turns to both sides at changing speed; back."""
    steps, now, heading = [], 0.0, draw.uniform(0, 360)

    def step(lasts_s, turn_deg, speed_m_s, depth_m):
        nonlocal now, heading
        heading = (heading + turn_deg) % 360
        steps.append({"at_s": round(now, 3), "speed_m_s": speed_m_s, "heading_deg": round(heading, 3), "depth_m": depth_m})
        now += lasts_s

    step(rest_s, 0, 0.0, 0.0)
    for turn in (60, -60):
        for i in range(round(16 * legs)):
            step(10, turn, 2.5 if i % 2 else 1.0, 0.0)
    for i in range(round(34 * legs)):
        step(14, 90 if i % 3 else -110, 2.4 if i % 2 else 1.1, 4.0 + 8.0 * (i // 2 % 2))
    step(40, 0, 2.0, 0.0)
    for i in range(round(10 * legs)):
        step(10, 60 if i % 2 else -60, 2.5 if i % 3 else 1.0, 0.0)
    return steps, now


def vehicle(seed, short=False):
    """The scenario, and the truth of each instrument."""
    draw = random.Random(f"blind {seed}")
    port = 21000 + seed % 400 * 20
    box = turns.of_a_box()

    def turned(base):
        return turns.product(base, turns.from_rpy([draw.uniform(-5, 5) for _ in range(3)]))

    def anywhere(half):
        return [round(draw.uniform(-half, half), 3) for _ in range(3)]

    kinds = ALWAYS + [kind for kind in SPOKEN if kind not in ALWAYS and draw.random() < 0.5]
    sensors = {}
    for kind in kinds:
        protocols, rates = SPOKEN[kind]
        link = draw.choice(["pty", "tcp_server", "udp"])
        port += 1
        sensors[kind] = {
            "enabled": True, "protocol": draw.choice(protocols), "rate_hz": draw.choice(rates),
            "link": {"type": link, "path": kind} if link == "pty" else {"type": link, "port": port},
            "latency_s": round(draw.uniform(0.001, 0.003) if kind == "imu" else draw.uniform(0.02, 0.1), 4),
            "jitter_s": 0.001 if kind == "imu" else 0.01,
        }
        if kind in LATE_S:
            sensors[kind]["stamp_late_s"] = round(draw.uniform(*LATE_S[kind]), 4)
    imu = turned(draw.choice(box))
    # A DVL looks down, whichever way round.
    dvl = turned(turns.from_rpy([0, 0, draw.choice([0, 90, 180, -90])]))
    gyro, force = draw.uniform(0.05, 0.2), draw.uniform(0.02, 0.06)
    sensors["imu"] |= {
        "mounting_rpy_deg": turns.to_rpy(imu),
        "gyro": {"bias_sigma_deg_h": draw.uniform(1, 20), "instability_sigma_deg_h": 0.3, "random_walk_deg_sqrt_h": gyro,
                 "scale_ppm": 200, "misalignment_mrad": 0.3},
        "accelerometer": {"bias_sigma_mg": draw.uniform(0.3, 2), "instability_sigma_mg": 0.03,
                          "random_walk_m_s_sqrt_h": force, "scale_ppm": 200, "misalignment_mrad": 0.3},
    }
    speed_sigma = draw.uniform(0.02, 0.06)
    sensors["gps"] |= {
        "lever_B_m": [round(draw.uniform(-0.5, 0.5), 3), round(draw.uniform(-0.3, 0.3), 3), round(draw.uniform(-0.8, -0.4), 3)],
        "position_sigma_m": draw.uniform(0.3, 0.8), "velocity_sigma_m_s": speed_sigma, "velocity_down_sigma_m_s": 2 * speed_sigma}
    sensors["dvl"] |= {
        "mounting_rpy_deg": turns.to_rpy(dvl), "lever_B_m": anywhere(0.5), "beam_sigma_m_s": draw.uniform(0.002, 0.006),
        "beam_sigma_per_speed": draw.uniform(0.001, 0.002), "scale_sigma": 0.002, "maximum_range_m": 110,
        "beam_dropout_probability": 0.005, "outlier_probability": 0.002}
    sensors["depth"] |= {"lever_B_m": [0.0, 0.0, 0.0], "bias_sigma_m": 0.03, "sigma_m": 0.02}
    sensors["heading"] |= {"bias_sigma_deg": 0.3, "sigma_deg": draw.uniform(0.2, 0.5),
                           "deviation_deg": [0.0, round(draw.uniform(-0.4, 0.4), 3), round(draw.uniform(-0.4, 0.4), 3), 0.0, 0.0]}
    steps, duration_s = mission(draw, 60 if short else 150, 0.3 if short else 1.0)
    scenario = {
        "name": f"blind{seed}", "description": "a vehicle drawn by seed", "duration_s": duration_s,
        "environment": {"surface_altitude_m": 18.5, "geoid_separation_m": 18.2, "water_depth_m": 45, "turbulence_m_s": 0.01,
                        "turbulence_tau_s": 2.0, "current_N_m_s": [0.12, -0.18], "current_from_s": steps[1]["at_s"],
                        "current_ramp_s": 10},
        "start": {"latitude_deg": round(draw.uniform(-60, 60), 4), "longitude_deg": 127.4, "depth_m": 0.12,
                  "rpy_deg": [0.5, -0.8, steps[0]["heading_deg"]]},
        "vehicle": {"kind": "auv"}, "mission": steps, "sensors": sensors, "bridges": [],
        "limits": {"horizontal_rms_m": 3.0}}
    if "usbl" in sensors:
        sensors["usbl"] |= {"minimum_depth_m": -10}
    if "range" in sensors:
        sensors["range"] |= {"minimum_depth_m": -10, "beacons": [{"address": "12", "place_N_m": [100, 40, 20]}]}
    truth = {"C_BI": imu, "C_BD": dvl, "gyro": gyro, "accelerometer": force,
             "lever": {kind: sensors[kind]["lever_B_m"] for kind in ("gps", "dvl")},
             "late_s": {kind: sensors[kind]["stamp_late_s"] for kind in LATE_S}}
    return scenario, truth
