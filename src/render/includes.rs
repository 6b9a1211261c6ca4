//! TEMPORARY
pub enum Include {
    Literal(String),
    Computed,
}
pub fn includes(text: &str) -> Vec<Include> {
    text.split("#include \"")
        .skip(1)
        .filter_map(|r| r.split('"').next())
        .map(|n| Include::Literal(n.to_owned()))
        .collect()
}
