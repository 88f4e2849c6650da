//! Numbers from bytes. Similar bytes give similar numbers, which helps a fuzzer.

/// Bytes that are consumed one after the other. Zeros follow the last one.
#[derive(Clone, Debug)]
pub struct Draw<'a>(&'a [u8]);

impl<'a> Draw<'a> {
    /// A source of these bytes.
    pub fn new(bytes: &'a [u8]) -> Self {
        Self(bytes)
    }

    /// Whether all bytes are consumed.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    fn bytes<const N: usize>(&mut self) -> [u8; N] {
        let (taken, rest) = self.0.split_at(N.min(self.0.len()));
        self.0 = rest;
        let mut bytes = [0; N];
        bytes[..taken.len()].copy_from_slice(taken);
        bytes
    }

    /// One byte.
    pub fn byte(&mut self) -> u8 {
        let [byte] = self.bytes();
        byte
    }

    /// A number below `end`, which is at most 256; 0 if `end` is 0.
    pub fn below(&mut self, end: usize) -> usize {
        usize::from(self.byte()) % end.max(1)
    }

    /// One of a few values.
    pub fn pick<T: Copy>(&mut self, values: &[T]) -> Option<T> {
        values.get(self.below(values.len())).copied()
    }

    /// Whether a rare case, with a probability of `odds` in 256, is drawn.
    pub fn rarely(&mut self, odds: u8) -> bool {
        self.byte() > u8::MAX - odds
    }

    /// A multiple of 1/64 in [-2, 2): few enough values for touching and coplanar cases to be common.
    pub fn grid(&mut self) -> f64 {
        f64::from(i8::from_le_bytes(self.bytes())) / 64.0
    }

    /// A power of two with an exponent of at most `largest` in magnitude.
    pub fn power(&mut self, largest: i8) -> f64 {
        let exponent = i32::from(i8::from_le_bytes(self.bytes())) % (i32::from(largest) + 1);
        2f64.powi(exponent)
    }

    /// Any number, including infinite and subnormal ones and NaN.
    pub fn any(&mut self) -> f64 {
        f64::from_le_bytes(self.bytes())
    }

    /// Any finite number. Other numbers are replaced by zero.
    pub fn finite(&mut self) -> f64 {
        let number = self.any();
        if number.is_finite() { number } else { 0.0 }
    }
}
