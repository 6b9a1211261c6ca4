//! Translates values from other programs, such as names of integrators.

/// Returns the word in `words` that corresponds to a word from another program. `None` if no word corresponds.
pub(in crate::scene::check) fn other_word<'a>(word: &str, words: &[&'a str]) -> Option<&'a str> {
    /// Each word of the scene language, with the words for it in other programs.
    const WORD_SYNONYMS: [(&str, &[&str]); 23] = [
        ("rk4", &["rk", "rk-4", "runge-kutta", "runge-kutta-4"]),
        ("dop853", &["rk45", "ode45", "dopri5", "dopri", "rk8", "dormand-prince", "adaptive", "lsoda"]),
        ("gauss-radau", &["ias15", "radau", "gauss-radau-15", "everhart", "radau15", "ra15"]),
        ("wisdom-holman", &["wh", "whfast", "wisdom-holmann", "wisdomholman", "mvs"]),
        ("velocity-verlet", &["verlet", "leapfrog", "leap-frog", "stormer-verlet", "vv", "kdk"]),
        ("yoshida4", &["yoshida", "yoshida-4", "forest-ruth", "symplectic4", "symplectic-4"]),
        ("euler-cromer", &["euler", "symplectic", "symplectic-euler", "semi-implicit-euler", "cromer"]),
        ("explicit-euler", &["forward-euler", "euler-forward", "explicit"]),
        ("event-driven", &["true", "yes", "on", "event", "events", "exact", "hard", "rigid", "impulse"]),
        ("orthographic", &["ortho", "parallel", "orthogonal"]),
        ("daylight", &["day", "outdoor", "outdoors", "sky", "default"]),
        ("studio", &["indoor", "indoors", "lab", "room"]),
        ("paper", &["white", "none", "print"]),
        ("space", &["stars", "black", "universe"]),
        ("top-left", &["upper-left", "left-top", "topleft", "northwest"]),
        ("top-right", &["upper-right", "right-top", "topright", "northeast"]),
        ("top", &["top-center", "top-centre", "top-middle", "upper", "above", "north"]),
        ("bottom", &["bottom-center", "bottom-centre", "bottom-middle", "lower", "below", "south"]),
        ("bottom-left", &["lower-left", "left-bottom", "bottomleft", "southwest"]),
        ("bottom-right", &["lower-right", "right-bottom", "bottomright", "southeast"]),
        ("above", &["top", "up", "over"]),
        ("below", &["bottom", "down", "under"]),
        ("wall", &["xy", "upright", "vertical", "back"]),
    ];
    let folded = word.trim().to_lowercase().replace([' ', '_'], "-");
    let known = |name: &str| words.iter().find(|known| **known == name).copied();
    known(&folded).or_else(|| {
        let mut meant = WORD_SYNONYMS.iter().filter(|(_, others)| others.contains(&folded.as_str()));
        meant.find_map(|(name, _)| known(name))
    })
}
