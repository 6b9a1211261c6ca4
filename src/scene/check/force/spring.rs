//! Reads springs from `[force.NAME.spring]`.

use super::super::end;
use super::super::view::View;
use super::Reader;
use crate::diagnostic::{Code, Diagnostic, Span};
use crate::physics::{Anchor, Spring};
use crate::scene::ForceKind;
use crate::scene::grammar::forces::spring;
use crate::scene::source::Node;

impl Reader<'_, '_> {
    /// Reads a chain of springs: one spring between each two consecutive ends in `between`.
    pub(super) fn spring(&mut self, view: &View<'_>) -> Option<ForceKind> {
        let nodes = view.list(&spring::BETWEEN)?;
        self.chain_of_groups(nodes, view.span(&spring::BETWEEN));
        let rest_length = view.get(&spring::REST_LENGTH);
        let stiffness = view.get(&spring::STIFFNESS)?;
        let damping = view.get(&spring::DAMPING);
        let mut links = Vec::with_capacity(nodes.len());
        for neighbours in nodes.windows(2) {
            let [first, second] = neighbours else { continue };
            let (Some(from), Some(to)) =
                (end::anchor(first, self.context), end::anchor(second, self.context))
            else {
                continue;
            };
            self.link(first, second, [from, to]);
            if rest_length.is_none() {
                self.copies_apart([first, second], [from, to]);
            }
            let length = || end::place(from, self.bodies).distance(end::place(to, self.bodies));
            let rest_length = rest_length.unwrap_or_else(length);
            links.push(Spring { between: [from, to], stiffness, damping, rest_length });
        }
        Some(ForceKind::Spring { links, look: super::super::showing::spring(view, self.context) })
    }

    /// Warns if `between` names two or more repeated bodies. All copies form a single chain, but the user may have meant pairs of copies.
    fn chain_of_groups(&mut self, nodes: &[Node], between: Option<Span>) {
        // All copies of a body have the span of the body's name.
        let mut groups: Vec<&[Node]> = nodes.chunk_by(|a, b| a.span == b.span).collect();
        let count = groups.len();
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
        let original = |name: &str| self.context.groups.original(name).unwrap_or(name).to_owned();
        let pairs = format!("[\"{}[i]\", \"{}[i]\"]", original(&from), original(&to));
        let help = format!("for pairs, write `between = {pairs}`");
        let is_plain = nodes.iter().all(|node| node.as_str().is_some());
        let warning =
            warning.at(last[0].span, format!("the chain goes from `{from}` through every copy to `{to}`"));
        let warning = warning.help(help);
        self.context.diagnostics.push(
            match between.filter(|_| is_plain && count == 2 && first.len() == last.len()) {
                Some(between) => warning.fix(between, pairs).fix_is_said(),
                None => warning,
            },
        );
    }

    /// Warns of a spring between two copies with the same initial location. The rest length would be 0, which is probably not intended.
    fn copies_apart(&mut self, nodes: [&Node; 2], between: [Anchor; 2]) {
        let bodies = self.bodies;
        let is_copy = |end: &Anchor| {
            end.body().is_some_and(|id| self.context.groups.original(&bodies[id.index()].name).is_some())
        };
        let is_same = between[0].body() == between[1].body();
        let [from, to] = between.map(|end| end::place(end, bodies));
        if is_same || from != to || !between.iter().all(is_copy) {
            return;
        }
        let span = nodes[1].span;
        let warning = || {
            let message = "a spring between copies that start at the same place has no length";
            Diagnostic::warning(Code::SpringEnds, message)
                .at(span, "where its other end is")
                .help("formulas of `i` set copies apart; if this is meant, write `rest_length = 0`")
        };
        self.report(Code::SpringEnds, span, warning);
    }

    /// Reports a spring if its two ends are the same point, lie on the same body, or are both immovable.
    fn link(&mut self, first: &Node, second: &Node, between: [Anchor; 2]) {
        let moves = |end: Anchor| end.body().is_some_and(|id| !self.bodies[id.index()].start.fixed);
        if between[0] == between[1] {
            let message = "both ends of the spring are at the same place";
            let error = || {
                Diagnostic::error(Code::SpringEnds, message).at(second.span, "the same as the end before it")
            };
            self.report(Code::SpringEnds, second.span, error);
        } else if between[0].body().is_some() && between[0].body() == between[1].body() {
            let message = "both ends of the spring are on the same body";
            let error = || {
                Diagnostic::error(Code::SpringEnds, message).at(second.span, "a rigid body does not stretch")
            };
            self.report(Code::SpringEnds, second.span, error);
        } else if !between.into_iter().any(moves) {
            let error = || {
                let error = Diagnostic::error(Code::SpringEnds, "neither end of the spring can move");
                let help = "one end at least must be a body that is not fixed";
                error.at(first.span, "").at(second.span, "").help(help)
            };
            self.report(Code::SpringEnds, first.span, error);
        }
    }
}
