//! Names of a label's measures in other programs.

/// The measure of a body that a word means, with the coordinate after it, if there is one: `velocity` and `x` mean
/// `vx`.
pub(super) fn of_body(word: &str, axis: Option<&str>) -> Option<String> {
    let folded = word.to_lowercase();
    let letter = match folded.as_str() {
        "location" | "position" | "pos" | "r" | "center" => "",
        "velocity" | "vel" | "v" => "v",
        "acceleration" | "acc" | "a" => "a",
        "force" | "f" => "f",
        _ => "none",
    };
    if let (Some(axis @ ("x" | "y" | "z")), true) = (axis, letter != "none") {
        return Some(format!("{letter}{axis}"));
    }
    Some(
        match folded.as_str() {
            "velocity" | "vel" | "v" => "speed",
            "height" | "h" | "altitude" => "y",
            "location" | "position" | "pos" => "x",
            "omega" | "angular_velocity" | "angular_speed" | "rotation" => "spin",
            "energy" | "ke" | "kinetic_energy" | "ekin" => "kinetic",
            "a" | "acc" => "acceleration",
            "f" => "force",
            "m" => "mass",
            "p" => "momentum",
            _ => return None,
        }
        .to_owned(),
    )
}

/// The measure of the run that a word means.
pub(super) fn of_run(word: &str) -> Option<&'static str> {
    Some(match word.to_lowercase().as_str() {
        "time" | "clock" => "t",
        "total" | "total_energy" | "e_total" | "etot" => "energy",
        "kinetic" | "ke" | "e_kin" | "ekin" => "kinetic_energy",
        "potential" | "pe" | "e_pot" | "epot" => "potential_energy",
        "step" | "frame_number" => "frame",
        _ => return None,
    })
}

/// The measure of a joint that a word means.
pub(super) fn of_joint(word: &str) -> Option<&'static str> {
    Some(match word.to_lowercase().as_str() {
        "f" | "tension" | "reaction" | "load" | "pull" => "force",
        "m" | "moment" | "tau" => "torque",
        "force_x" => "fx",
        "force_y" => "fy",
        "force_z" => "fz",
        "torque_x" => "tx",
        "torque_y" => "ty",
        "torque_z" => "tz",
        _ => return None,
    })
}
