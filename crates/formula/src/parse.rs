//! From text to an expression, with the precedence that Python has.
//!
//! ```text
//! comparison = sum [("<" | "<=" | ">" | ">=") sum]
//! sum        = product {("+" | "-") product}
//! product    = signed {("*" | "/") signed}
//! signed     = ("-" | "+") signed | power
//! power      = atom ["**" signed]
//! atom       = number | name | function "(" comparison {"," comparison} ")" | "(" comparison ")"
//! ```

use crate::error::FormulaError;
use crate::expression::{Expression, Function, Operator};

/// Characters of a formula at most.
pub const MOST_CHARACTERS: usize = 1000;
/// Numbers, names and operations of a formula at most.
pub const MOST_NODES: usize = 256;
/// Levels of a formula at most: of the tree, and of parentheses and signs as they are written.
pub const MOST_DEPTH: usize = 48;

/// An expression, and the character at which each of its parts begins, each after its own parts.
#[derive(Debug, Clone, PartialEq)]
pub struct Parsed {
    pub expression: Expression,
    pub places: Vec<usize>,
}

#[derive(Debug, Clone, PartialEq)]
enum Token {
    Number(f64),
    Name(String),
    Sign(&'static str),
    End,
}

/// Two characters before one.
const SIGNS: [&str; 12] = ["**", "<=", ">=", "<", ">", "+", "-", "*", "/", "(", ")", ","];

fn tokens(text: &str) -> Result<Vec<(usize, Token)>, FormulaError> {
    let characters: Vec<char> = text.chars().collect();
    let mut tokens = Vec::new();
    let mut i = 0;
    while i < characters.len() {
        let c = characters[i];
        let length = match c {
            _ if c.is_ascii_whitespace() => 1,
            _ if c.is_ascii_digit() || c == '.' => {
                let (length, value) = number(&characters, i)?;
                tokens.push((i + 1, Token::Number(value)));
                length
            }
            _ if c.is_ascii_alphabetic() || c == '_' => {
                let name: String = characters[i..].iter().take_while(|c| is_of_name(**c)).collect();
                let length = name.len();
                tokens.push((i + 1, Token::Name(name)));
                length
            }
            _ => {
                let sign = sign(&characters[i..]).ok_or_else(|| stranger(i, c))?;
                tokens.push((i + 1, Token::Sign(sign)));
                sign.len()
            }
        };
        i += length;
    }
    tokens.push((characters.len() + 1, Token::End));
    Ok(tokens)
}

fn is_of_name(c: char) -> bool {
    c.is_ascii_alphanumeric() || c == '_'
}

fn sign(rest: &[char]) -> Option<&'static str> {
    SIGNS.into_iter().find(|sign| rest.len() >= sign.len() && sign.chars().zip(rest).all(|(a, b)| a == *b))
}

fn stranger(i: usize, c: char) -> FormulaError {
    let allowed = match c {
        '^' => "`**` for a power",
        '=' | '!' => "the comparisons < <= > >=: a motion meets a single number at no time",
        '×' | '·' => "`*` for a product",
        _ => "numbers, names, + - * / ** < <= > >= ( ) and commas",
    };
    FormulaError::new(Some(i + 1), format!("`{c}`"), allowed)
}

/// A number as Python writes one: `2`, `0.5`, `.5`, `1e-3`.
fn number(characters: &[char], from: usize) -> Result<(usize, f64), FormulaError> {
    let rest = &characters[from..];
    let digits = |at: usize| rest[at.min(rest.len())..].iter().take_while(|c| c.is_ascii_digit()).count();
    let mut end = digits(0);
    if rest.get(end) == Some(&'.') {
        end += 1 + digits(end + 1);
    }
    if matches!(rest.get(end), Some('e' | 'E')) {
        let signed = usize::from(matches!(rest.get(end + 1), Some('+' | '-')));
        let exponent = digits(end + 1 + signed);
        end += if exponent > 0 { 1 + signed + exponent } else { 0 };
    }
    let text: String = rest[..end].iter().collect();
    let follows = rest.get(end).is_some_and(|c| is_of_name(*c) || *c == '.');
    let value = text.parse::<f64>().ok().filter(|value| value.is_finite() && !follows);
    let found: String = rest[..end + usize::from(follows)].iter().collect();
    value.map(|value| (end, value)).ok_or_else(|| {
        FormulaError::new(
            Some(from + 1),
            format!("`{found}`"),
            "a finite number such as 2, 0.5 or 1e-3, and `*` before a name",
        )
    })
}

struct Parser {
    tokens: Vec<(usize, Token)>,
    next: usize,
    level: usize,
    nodes: usize,
}

/// A part and the places of all its parts.
type Part = (Expression, Vec<usize>);

/// Reads a text as an expression.
///
/// # Errors
/// Where the text is no expression; a text that is too long or nested too deeply.
pub fn parse(text: &str) -> Result<Parsed, FormulaError> {
    let characters = text.chars().count();
    if characters > MOST_CHARACTERS {
        let found = format!("{characters} characters");
        return Err(FormulaError::new(None, found, format!("at most {MOST_CHARACTERS}")));
    }
    let mut parser = Parser { tokens: tokens(text)?, next: 0, level: 0, nodes: 0 };
    let (expression, places) = parser.comparison()?;
    match parser.peek() {
        Token::End => {}
        _ => return Err(parser.refused("an operator, or the end of the formula")),
    }
    let depth = expression.depth();
    if depth > MOST_DEPTH {
        let found = format!("a formula of {depth} levels");
        return Err(FormulaError::new(None, found, format!("at most {MOST_DEPTH} levels")));
    }
    Ok(Parsed { expression, places })
}

impl Parser {
    fn peek(&self) -> &Token {
        &self.tokens[self.next].1
    }

    fn place(&self) -> usize {
        self.tokens[self.next].0
    }

    fn take(&mut self, sign: &str) -> bool {
        let found = matches!(self.peek(), Token::Sign(own) if *own == sign);
        self.next += usize::from(found);
        found
    }

    fn refused(&self, allowed: &str) -> FormulaError {
        let found = match self.peek() {
            Token::End => "the end of the formula".to_owned(),
            Token::Number(value) => format!("the number {value}"),
            Token::Name(name) => format!("`{name}`"),
            Token::Sign(sign) => format!("`{sign}`"),
        };
        FormulaError::new(Some(self.place()), found, allowed)
    }

    /// Counts what is made, so that nothing too large is.
    fn made(
        &mut self,
        at: usize,
        expression: Expression,
        parts: Vec<Vec<usize>>,
    ) -> Result<Part, FormulaError> {
        self.nodes += 1;
        if self.nodes > MOST_NODES {
            let found = format!("more than {MOST_NODES} numbers, names and operations");
            return Err(FormulaError::new(Some(at), found, "a shorter formula"));
        }
        let mut places = parts.concat();
        places.push(at);
        Ok((expression, places))
    }

    fn deeper<T>(
        &mut self,
        of: impl FnOnce(&mut Self) -> Result<T, FormulaError>,
    ) -> Result<T, FormulaError> {
        self.level += 1;
        if self.level > MOST_DEPTH {
            let found = "parentheses or signs nested too deeply";
            return Err(FormulaError::new(Some(self.place()), found, format!("at most {MOST_DEPTH} levels")));
        }
        let inner = of(self);
        self.level -= 1;
        inner
    }

    fn binary(&mut self, operator: Operator, (a, at_a): Part, (b, at_b): Part) -> Result<Part, FormulaError> {
        // A part begins where its first part does: the last place is its own.
        let at = first_place(&at_a);
        self.made(at, Expression::binary(operator, a, b), vec![at_a, at_b])
    }

    fn comparison(&mut self) -> Result<Part, FormulaError> {
        let left = self.sum()?;
        let Some(operator) = self.compared() else { return Ok(left) };
        let right = self.sum()?;
        let compared = self.binary(operator, left, right)?;
        let again = self.place();
        match self.compared() {
            None => Ok(compared),
            Some(_) => Err(FormulaError::new(
                Some(again),
                "a second comparison",
                "one comparison, or both in parentheses: (a < x)*(x < b)",
            )),
        }
    }

    fn compared(&mut self) -> Option<Operator> {
        use Operator::{Greater, GreaterOrEqual, Less, LessOrEqual};
        [Less, LessOrEqual, Greater, GreaterOrEqual].into_iter().find(|operator| self.take(operator.sign()))
    }

    fn sum(&mut self) -> Result<Part, FormulaError> {
        let mut left = self.product()?;
        loop {
            let operator = match self.peek() {
                Token::Sign("+") => Operator::Add,
                Token::Sign("-") => Operator::Subtract,
                _ => return Ok(left),
            };
            self.next += 1;
            let right = self.product()?;
            left = self.binary(operator, left, right)?;
        }
    }

    fn product(&mut self) -> Result<Part, FormulaError> {
        let mut left = self.signed()?;
        loop {
            let operator = match self.peek() {
                Token::Sign("*") => Operator::Multiply,
                Token::Sign("/") => Operator::Divide,
                _ => return Ok(left),
            };
            self.next += 1;
            let right = self.signed()?;
            left = self.binary(operator, left, right)?;
        }
    }

    fn signed(&mut self) -> Result<Part, FormulaError> {
        let at = self.place();
        if self.take("+") {
            return self.deeper(Self::signed);
        }
        if !self.take("-") {
            return self.power();
        }
        let (inner, places) = self.deeper(Self::signed)?;
        self.made(at, Expression::Negative(Box::new(inner)), vec![places])
    }

    fn power(&mut self) -> Result<Part, FormulaError> {
        let base = self.atom()?;
        if !self.take("**") {
            return Ok(base);
        }
        let exponent = self.deeper(Self::signed)?;
        self.binary(Operator::Power, base, exponent)
    }

    fn atom(&mut self) -> Result<Part, FormulaError> {
        let at = self.place();
        match self.peek().clone() {
            Token::Number(value) => {
                self.next += 1;
                self.made(at, Expression::Number(value), Vec::new())
            }
            Token::Name(name) => {
                self.next += 1;
                self.named(at, name)
            }
            Token::Sign("(") => {
                self.next += 1;
                let inner = self.deeper(Self::comparison)?;
                self.close(inner)
            }
            _ => Err(self.refused("a number, a name, a function or `(`")),
        }
    }

    fn close(&mut self, inner: Part) -> Result<Part, FormulaError> {
        if self.take(")") { Ok(inner) } else { Err(self.refused("an operator or `)`")) }
    }

    fn named(&mut self, at: usize, name: String) -> Result<Part, FormulaError> {
        let function = Function::ALL.into_iter().find(|function| function.name() == name);
        if !self.take("(") {
            return match function {
                None => self.made(at, Expression::Name(name), Vec::new()),
                Some(_) => Err(self.refused(&format!("`(` after `{name}`"))),
            };
        }
        let Some(function) = function else {
            let known = Function::ALL.map(Function::name).join(", ");
            return Err(FormulaError::new(
                Some(at),
                format!("a function `{name}`"),
                format!("one of {known}"),
            ));
        };
        let mut arguments = vec![self.deeper(Self::comparison)?];
        while self.take(",") {
            arguments.push(self.deeper(Self::comparison)?);
        }
        let called = self.called(at, function, arguments)?;
        self.close(called)
    }

    fn called(&mut self, at: usize, function: Function, arguments: Vec<Part>) -> Result<Part, FormulaError> {
        let count = arguments.len();
        if function.takes_two() != (count > 1) {
            let allowed = if function.takes_two() { "two or more" } else { "one" };
            let found = format!("{count} numbers for `{}`", function.name());
            return Err(FormulaError::new(Some(at), found, allowed));
        }
        let mut arguments = arguments.into_iter();
        let Some((mut so_far, mut places)) = arguments.next() else {
            return Err(self.refused("a number, a name, a function or `(`"));
        };
        if count == 1 {
            return self.made(at, Expression::Of(function, Box::new(so_far)), vec![places]);
        }
        for (next, at_next) in arguments {
            let two = Expression::OfTwo(function, Box::new(so_far), Box::new(next));
            (so_far, places) = self.made(at, two, vec![places, at_next])?;
        }
        Ok((so_far, places))
    }
}

/// Where a part begins.
fn first_place(places: &[usize]) -> usize {
    places.last().copied().unwrap_or(1)
}
