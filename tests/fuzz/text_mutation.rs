//! Random bytes as mutations of a text.

/// Pieces that are inserted: what the formats give a meaning, and numbers at the ends of their
/// ranges.
const TOKENS: [&str; 32] = [
    "\n",
    "\"",
    "\"\"",
    ",",
    "=",
    "[",
    "]]",
    "[shooter]\n",
    "#",
    "\\",
    "'''",
    ".",
    "-",
    "0",
    "1e308",
    "-1e308",
    "1e-308",
    "nan",
    "inf",
    "-0.0",
    "9223372036854775808",
    " ft",
    " deg",
    " rev/s",
    "true",
    "\u{202e}",
    "\u{0}",
    "\r\n",
    "\u{feff}",
    "é",
    "{ a = 1 }",
    "\t",
];

/// Random bytes that are used up one by one; then they are zero.
pub(crate) struct Script<'a> {
    bytes: std::slice::Iter<'a, u8>,
}

impl<'a> Script<'a> {
    pub(crate) fn new(bytes: &'a [u8]) -> Self {
        Self {
            bytes: bytes.iter(),
        }
    }

    pub(crate) fn byte(&mut self) -> u8 {
        self.bytes.next().copied().unwrap_or(0)
    }

    /// A number from 0 to 1.
    pub(crate) fn fraction(&mut self) -> f64 {
        f64::from(u16::from_le_bytes([self.byte(), self.byte()])) / 65535.0
    }

    pub(crate) fn choose<'t>(&mut self, texts: &[&'t str]) -> &'t str {
        texts[self.byte() as usize % texts.len()]
    }

    fn position(&mut self, length: usize) -> usize {
        (self.fraction() * length as f64) as usize
    }

    /// Up to eight mutations of a text.
    pub(crate) fn mutate(&mut self, text: &[u8]) -> Vec<u8> {
        let mut text = text.to_vec();
        for _ in 0..self.byte() % 9 {
            let at = self.position(text.len()).min(text.len());
            let length = self.byte() as usize;
            let end = (at + length).min(text.len());
            match self.byte() % 6 {
                0 => {
                    text.drain(at..end);
                }
                1 => {
                    let copy = text[at..end].to_vec();
                    let to = self.position(text.len());
                    text.splice(to..to, copy);
                }
                2 | 3 => {
                    let token = TOKENS[length % TOKENS.len()];
                    text.splice(at..at, token.bytes());
                }
                4 => {
                    if let Some(byte) = text.get_mut(at) {
                        *byte ^= 1 << (length % 8);
                    }
                }
                _ => {
                    // Replace the number or word that stands here.
                    let is_word = |byte: &u8| byte.is_ascii_alphanumeric() || *byte == b'.';
                    let tail = text[at..].iter().take_while(|byte| is_word(byte)).count();
                    let token = TOKENS[length % TOKENS.len()];
                    text.splice(at..at + tail, token.bytes());
                }
            }
        }
        text
    }
}
