//! Translates names of measures from other programs into the measures of labels.

/// Returns the measure of a body that corresponds to a word from another program. `axis` is the coordinate that follows the word:
/// `velocity` with `x` gives `vx`.
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
            "pe" | "potential_energy" | "epot" => "potential",
            "l" => "angular_momentum",
            "normal" => "normal_force",
            "friction" => "friction_force",
            _ => return None,
        }
        .to_owned(),
    )
}

/// Returns the measure of the run that corresponds to a word from another program.
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

/// Returns the measure of a joint that corresponds to a word from another program.
pub(super) fn of_joint(word: &str) -> Option<&'static str> {
    Some(match word.to_lowercase().as_str() {
        "f" | "tension" | "reaction" | "load" | "pull" => "force",
        "m" | "moment" | "tau" => "torque",
        "force_x" => "fx",
        "force_y" => "fy",
        "force_z" => "fz",
        "motor_torque" | "motor_force" | "effort" | "drive" | "actuator" => "motor",
        "thrust" | "axial" => "axial_force",
        "turns" | "revolutions" | "unwrapped" => "total_angle",
        "torque_x" => "tx",
        "torque_y" => "ty",
        "torque_z" => "tz",
        _ => return None,
    })
}

/// Returns the measure of a force that corresponds to a word from another program.
pub(super) fn of_force(word: &str) -> Option<&'static str> {
    Some(match word.to_lowercase().as_str() {
        "fx" | "force_x" => "x",
        "fy" | "force_y" => "y",
        "fz" | "force_z" => "z",
        "force" | "f" | "magnitude" | "length" | "norm" | "abs" => "size",
        "work" | "p" => "power",
        "energy" | "pe" | "epot" => "potential",
        _ => return None,
    })
}
