//! `[force.NAME.spring]`.

use super::super::end;
use super::super::view::View;
use super::Reader;
use crate::diagnostic::{Code, Diagnostic};
use crate::dynamics::{Anchor, Spring};
use crate::scene::ForceKind;
use crate::scene::source::Node;

impl Reader<'_, '_> {
    /// A spring from each end to the next.
    pub(super) fn spring(&mut self, view: &View<'_>) -> Option<ForceKind> {
        let nodes = view.list("between")?;
        self.chain_of_groups(nodes);
        let rest_length = view.number("rest_length");
        let stiffness = view.number("stiffness").unwrap_or(0.0);
        let damping = view.number("damping").unwrap_or(0.0);
        let mut links = Vec::with_capacity(nodes.len());
        for neighbours in nodes.windows(2) {
            let [first, second] = neighbours else { continue };
            let (Some(from), Some(to)) =
                (end::anchor(first, self.context), end::anchor(second, self.context))
            else {
                continue;
            };
            self.link(first, second, [from, to]);
            let length = || end::place(from, self.bodies).distance(end::place(to, self.bodies));
            let rest_length = rest_length.unwrap_or_else(length);
            links.push(Spring { between: [from, to], stiffness, damping, rest_length });
        }
        Some(ForceKind::Spring { links, look: super::super::showing::spring(view, self.context) })
    }

    /// Warns of several bodies that are repeated: their copies make one chain, where pairs may have been meant.
    fn chain_of_groups(&mut self, nodes: &[Node]) {
        // The copies of a body all stand at the place of its name.
        let mut groups: Vec<&[Node]> = nodes.chunk_by(|a, b| a.span == b.span).collect();
        groups.retain(|group| group.len() > 1);
        let [first, .., last] = groups.as_slice() else { return };
        let body = |node: &Node| match node.as_table() {
            Some(end) => end.get("body").and_then(|entry| entry.node.as_str()).map(str::to_owned),
            None => node.as_str().map(str::to_owned),
        };
        let end = |node: Option<&Node>| node.and_then(body).unwrap_or_default();
        let (from, to) = (end(first.first()), end(last.last()));
        let message = "all copies make one chain, and not pairs";
        let warning = Diagnostic::warning(Code::OneChain, message);
        let help = format!(
            "for pairs, write a force for each: `between = [\"{from}\", \"{}\"]`, and so on",
            end(last.first())
        );
        let warning =
            warning.at(last[0].span, format!("the chain goes from `{from}` through every copy to `{to}`"));
        self.context.diagnostics.push(warning.help(help));
    }

    /// Two neighbouring ends must be different, and one of them able to move.
    fn link(&mut self, first: &Node, second: &Node, between: [Anchor; 2]) {
        let moves = |end: Anchor| end.body().is_some_and(|id| !self.bodies[id.index()].start.fixed);
        if between[0] == between[1] {
            let message = "both ends of the spring are at the same place";
            let error = || {
                Diagnostic::error(Code::SpringEnds, message).at(second.span, "the same as the end before it")
            };
            self.say(Code::SpringEnds, second.span, error);
        } else if between[0].body().is_some() && between[0].body() == between[1].body() {
            let message = "both ends of the spring are on the same body";
            let error = || {
                Diagnostic::error(Code::SpringEnds, message).at(second.span, "a rigid body does not stretch")
            };
            self.say(Code::SpringEnds, second.span, error);
        } else if !between.into_iter().any(moves) {
            let error = || {
                let error = Diagnostic::error(Code::SpringEnds, "neither end of the spring can move");
                let help = "one end at least must be a body that is not fixed";
                error.at(first.span, "").at(second.span, "").help(help)
            };
            self.say(Code::SpringEnds, first.span, error);
        }
    }
}
