//! Parses the tokens of a formula into an expression tree, by operator precedence (a Pratt parser).

use std::ops::Range;

use super::corrections;
use super::error::{ExpressionError, error, syntax};
use super::function::{FUNCTIONS, Function};
use super::lexer::{Lexer, Token};
use super::operation::{Binary, Unary};
use crate::diagnostic::{Code, nearest};

/// The maximum length of a formula, in bytes.
pub const MAX_LENGTH: usize = 10_000;
/// The maximum nesting depth of a formula. A parenthesis after an operator counts as two levels.
const MAX_DEPTH: usize = 200;

/// A parsed formula, before its names are looked up.
///
/// Operands come before the operations that use them, so a loop over the nodes evaluates the tree without recursion.
#[derive(Clone, Debug)]
pub struct Formula {
    text: Box<str>,
    /// The nodes of the expression tree. The last one is the root.
    pub(super) nodes: Vec<Node>,
}

/// The index of a node in the list of its tree.
pub(super) type Id = usize;

/// A subexpression of a formula, with its byte range in the text.
#[derive(Clone, Debug)]
pub(super) struct Node {
    pub(super) part: Subexpression,
    pub(super) range: Range<usize>,
}

/// A subexpression of a parsed formula.
#[derive(Clone, Debug)]
pub(super) enum Subexpression {
    Number(f64),
    /// The byte range of a name in the text. The range excludes parentheses around the name.
    Name(Range<usize>),
    Unary(Unary, Id),
    Binary(Binary, Id, Id),
    And(Id, Id),
    Or(Id, Id),
    Call(&'static Function, Box<[Id]>),
}

impl Formula {
    /// Parses the text of a formula.
    ///
    /// # Errors
    /// If the syntax is wrong, a function is unknown, or a function has too many or too few arguments.
    pub fn parse(text: &str) -> Result<Formula, Vec<ExpressionError>> {
        if text.len() > MAX_LENGTH {
            let message = format!("a formula is at most {MAX_LENGTH} characters long");
            return Err(vec![syntax(0..text.len(), message).help("give its parts names in `[variables]`")]);
        }
        if text.trim().is_empty() {
            return Err(vec![syntax(0..text.len(), "the formula is empty").label("expected a number")]);
        }
        let mut parser = Parser::new(text);
        let whole = parser.advance().and_then(|()| parser.whole());
        parser.errors.extend(whole.err());
        if parser.errors.is_empty() {
            Ok(Formula { text: text.into(), nodes: parser.nodes })
        } else {
            Err(parser.errors)
        }
    }

    /// Returns the text from which the formula was parsed.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Iterates over the variables and constants that the formula names, with their byte ranges. A name that occurs several times is
    /// returned several times. Functions are not included.
    pub fn names(&self) -> impl Iterator<Item = (&str, Range<usize>)> {
        self.nodes.iter().filter_map(|node| match &node.part {
            Subexpression::Name(range) => Some((&self.text[range.clone()], range.clone())),
            _ => None,
        })
    }
}

struct Parser<'a> {
    text: &'a str,
    lexer: Lexer<'a>,
    /// The next token of the formula. `range` is its byte range.
    token: Token,
    range: Range<usize>,
    /// The byte range of the previous token.
    before: Range<usize>,
    nodes: Vec<Node>,
    depth: usize,
    /// Errors after which the parser could continue.
    errors: Vec<ExpressionError>,
}

/// Returns the left and the right binding power of a binary operator. `None` for other tokens.
fn power(token: Token) -> Option<(u8, u8)> {
    match token {
        Token::Or => Some((1, 2)),
        Token::And => Some((3, 4)),
        Token::Less
        | Token::LessEqual
        | Token::Greater
        | Token::GreaterEqual
        | Token::Equal
        | Token::NotEqual => Some((COMPARISON_BINDING_POWER, COMPARISON_BINDING_POWER + 1)),
        Token::Plus | Token::Minus => Some((9, 10)),
        Token::Star | Token::Slash | Token::Percent => Some((11, 12)),
        // `^` is right-associative: 2^3^2 is 2^9.
        Token::Caret => Some((16, 15)),
        _ => None,
    }
}

/// The right binding power of `not`.
const NOT_BINDING_POWER: u8 = 5;
/// The left binding power of comparisons.
const COMPARISON_BINDING_POWER: u8 = 7;
/// The right binding power of the signs `-` and `+`: higher than that of `*`, lower than that of `^`.
const SIGN_BINDING_POWER: u8 = 13;

impl<'a> Parser<'a> {
    fn new(text: &'a str) -> Parser<'a> {
        Parser {
            text,
            lexer: Lexer::new(text),
            token: Token::End,
            range: 0..0,
            before: 0..0,
            nodes: Vec::new(),
            depth: 0,
            errors: Vec::new(),
        }
    }

    fn advance(&mut self) -> Result<(), ExpressionError> {
        self.before = self.range.clone();
        (self.token, self.range) = self.lexer.next()?;
        Ok(())
    }

    fn push(&mut self, part: Subexpression, range: Range<usize>) -> Id {
        self.nodes.push(Node { part, range });
        self.nodes.len() - 1
    }

    fn whole(&mut self) -> Result<(), ExpressionError> {
        self.expression(0)?;
        match self.token {
            Token::End => Ok(()),
            Token::Close => {
                Err(syntax(self.range.clone(), "a parenthesis is closed that has not been opened"))
            }
            Token::Comma => Err(syntax(self.range.clone(), "a comma where the formula should end")
                .help("a decimal point is a point: `1.5`; in a list, every number has a string of its own")),
            _ => Err(self.no_operator()),
        }
    }

    /// Parses an operand and all following operators whose binding power is at least `least`. Returns the id of the subexpression.
    fn expression(&mut self, least: u8) -> Result<Id, ExpressionError> {
        if self.depth >= MAX_DEPTH {
            let message = "too many parentheses, signs or powers stand in each other";
            let error = syntax(self.range.clone(), message);
            return Err(error.help("give parts of the formula names in `[variables]`"));
        }
        self.depth += 1;
        let mut left = self.operand()?;
        while let Some((binds_left, binds_right)) = power(self.token) {
            if binds_left < least {
                break;
            }
            let operator = self.token;
            let operator_range = self.range.clone();
            self.advance()?;
            let right = self.expression(binds_right)?;
            let range = self.nodes[left].range.start..self.nodes[right].range.end;
            left = self.push(combine(operator, left, right), range);
            if binds_left == COMPARISON_BINDING_POWER
                && power(self.token).is_some_and(|(next, _)| next == COMPARISON_BINDING_POWER)
            {
                let error =
                    syntax(operator_range.start..self.range.end, "comparisons do not follow each other");
                return Err(error.help("write `a < x and x < b` for «x is between a and b»"));
            }
        }
        self.depth -= 1;
        Ok(left)
    }

    fn operand(&mut self) -> Result<Id, ExpressionError> {
        let (token, range) = (self.token, self.range.clone());
        if token != Token::End {
            self.advance()?;
        }
        match token {
            Token::Number(number) => Ok(self.push(Subexpression::Number(number), range)),
            Token::Name if self.token == Token::Open => self.call(range),
            Token::Name => Ok(self.push(Subexpression::Name(range.clone()), range)),
            Token::Open => {
                let inner = self.expression(0)?;
                self.close(&range, "")?;
                // The range of a subexpression in parentheses includes the parentheses.
                self.nodes[inner].range = range.start..self.before.end;
                Ok(inner)
            }
            Token::Minus | Token::Plus | Token::Not => {
                let inner = self.expression(if token == Token::Not {
                    NOT_BINDING_POWER
                } else {
                    SIGN_BINDING_POWER
                })?;
                let range = range.start..self.nodes[inner].range.end;
                Ok(match token {
                    Token::Minus => self.push(Subexpression::Unary(Unary::Negate, inner), range),
                    Token::Not => self.push(Subexpression::Unary(Unary::Not, inner), range),
                    _ => inner,
                })
            }
            Token::End => {
                let place = if self.before.is_empty() { self.range.clone() } else { self.before.clone() };
                Err(syntax(place, "the formula ends where a value should follow"))
            }
            _ => {
                let message = format!("`{}` stands where a value should", &self.text[range.clone()]);
                Err(syntax(range, message))
            }
        }
    }

    /// Reads the closing parenthesis that belongs to the one at `open`. `between` is the advice for an error: it names the separator that
    /// is allowed within these parentheses.
    fn close(&mut self, open: &Range<usize>, between: &str) -> Result<(), ExpressionError> {
        match self.token {
            Token::Close => self.advance(),
            Token::End => Err(syntax(open.clone(), "this parenthesis is not closed")),
            Token::Comma => Err(syntax(self.range.clone(), "a comma where no function has its values")
                .help("a decimal point is a point: `1.5`")),
            _ if between.is_empty() => Err(self.no_operator()),
            _ => Err(self.no_operator().help(between)),
        }
    }

    /// Returns the error for two operands without an operator between them.
    fn no_operator(&self) -> ExpressionError {
        let (first, second) = (&self.text[self.before.clone()], &self.text[self.range.clone()]);
        if Function::named(first).is_some() {
            return syntax(self.before.clone(), format!("the values of `{first}` stand in parentheses"))
                .label(format!("write `{first}({second})`"));
        }
        let is_name = first.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_');
        let both = self.before.start..self.range.end;
        if !is_name && matches!(self.token, Token::Name | Token::Open) {
            // `2x`, `2(x + 1)` and `(a)(b)` are clearly meant as products, so a correction is suggested.
            let units = if crate::scene::units::is_unit(second) { "; units are not written" } else { "" };
            return syntax(both, "an operator is missing")
                .label(format!("write `{first}*{second}` to multiply{units}"))
                .fix(format!("{first}*{second}"));
        }
        syntax(both, "an operator is missing")
            .label(format!("nothing stands between `{first}` and `{second}`"))
    }

    /// Parses the arguments of a function call. The parser has already read the function's name, at the range `name`.
    fn call(&mut self, name: Range<usize>) -> Result<Id, ExpressionError> {
        let word = &self.text[name.clone()];
        let open = self.range.clone();
        self.advance()?;
        let mut values = Vec::new();
        if self.token != Token::Close {
            values.push(self.expression(0)?);
            while self.token == Token::Comma {
                self.advance()?;
                values.push(self.expression(0)?);
            }
        }
        self.close(&open, "a comma stands between the values of a function")?;
        let range = name.start..self.before.end;
        let Some(function) = Function::named(word) else {
            self.errors.push(unknown_function(word, name));
            return Ok(self.push(Subexpression::Number(0.0), range));
        };
        if !function.takes(values.len()) {
            self.errors.push(wrong_count(function, values.len(), range.clone()));
            return Ok(self.push(Subexpression::Number(0.0), range));
        }
        Ok(self.push(Subexpression::Call(function, values.into()), range))
    }
}

fn combine(operator: Token, left: Id, right: Id) -> Subexpression {
    let operation = match operator {
        Token::Or => return Subexpression::Or(left, right),
        Token::And => return Subexpression::And(left, right),
        Token::Less => Binary::Less,
        Token::LessEqual => Binary::LessEqual,
        Token::Greater => Binary::Greater,
        Token::GreaterEqual => Binary::GreaterEqual,
        Token::Equal => Binary::Equal,
        Token::NotEqual => Binary::NotEqual,
        Token::Minus => Binary::Subtract,
        Token::Star => Binary::Multiply,
        Token::Slash => Binary::Divide,
        Token::Percent => Binary::Modulo,
        Token::Caret => Binary::Power,
        _ => Binary::Add,
    };
    Subexpression::Binary(operation, left, right)
}

fn unknown_function(word: &str, name: Range<usize>) -> ExpressionError {
    let error = error(Code::UnknownName, name, format!("there is no function `{word}`"));
    let folded = word.to_lowercase();
    match (corrections::function(&folded), nearest(word, FUNCTIONS.iter().map(|function| function.name))) {
        (Some(habit), _) => {
            // A correction is offered only if it is enough to replace the name of the function.
            let name = habit.strip_prefix("write `").and_then(|rest| rest.strip_suffix('`'));
            let name = name.filter(|name| FUNCTIONS.iter().any(|function| function.name == *name));
            let error = error.label(habit);
            name.into_iter().fold(error, ExpressionError::fix)
        }
        (None, Some(near)) => error.label(format!("did you mean `{near}`?")).fix(near),
        (None, None) => {
            let names: Vec<&str> = FUNCTIONS.iter().map(|function| function.name).collect();
            let help = format!("there are {}; a product is written `{word}*(…)`", names.join(", "));
            error.help(help)
        }
    }
}

fn wrong_count(function: &Function, found: usize, range: Range<usize>) -> ExpressionError {
    let count = function.parameters.len();
    let least = if function.is_open { "at least " } else { "" };
    let s = if count == 1 { "" } else { "s" };
    let found = if found == 0 { "none".to_owned() } else { found.to_string() };
    let message = format!("`{}` takes {least}{count} value{s}, found {found}", function.name);
    error(Code::WrongCount, range, message).label(format!("write `{}`", function.usage()))
}
