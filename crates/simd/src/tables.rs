//! What lanes look up: columns of values, and matrices over the field of two elements.

/// Values that lanes look up by their index. Up to 32 of them fit into two registers of 16 lanes, and up to 16 into two
/// of 8: then a look-up is a permutation or two, else it is a load for each lane.
#[derive(Debug, Clone, Default)]
pub struct Column(Padded<f32>);

/// As [`Column`], of words.
#[derive(Debug, Clone, Default)]
pub struct WordColumn(Padded<u32>);

/// A list whose length is a power of two of at least [`Padded::LEAST`], so that backends may load whole registers.
#[derive(Debug, Clone)]
struct Padded<T>(Vec<T>);

impl<T: Copy + Default> Padded<T> {
    const LEAST: usize = 32;

    fn new(mut values: Vec<T>) -> Self {
        let len = values.len().next_power_of_two().max(Self::LEAST);
        values.resize(len, T::default());
        Padded(values)
    }
}

impl<T: Copy + Default> Default for Padded<T> {
    fn default() -> Self {
        Self::new(Vec::new())
    }
}

impl Column {
    /// The values in their order.
    pub fn new(values: impl IntoIterator<Item = f32>) -> Self {
        Column(Padded::new(values.into_iter().collect()))
    }

    /// The values, and zeros up to a power of two of at least 32.
    #[inline(always)]
    pub fn values(&self) -> &[f32] {
        &self.0.0
    }
}

impl WordColumn {
    /// The values in their order.
    pub fn new(values: impl IntoIterator<Item = u32>) -> Self {
        WordColumn(Padded::new(values.into_iter().collect()))
    }

    /// The values, and zeros up to a power of two of at least 32.
    #[inline(always)]
    pub fn values(&self) -> &[u32] {
        &self.0.0
    }
}

/// A 32 x 32 matrix over the field of two elements, unrolled into tables of its products with three, four and eight
/// bits.
#[derive(Debug)]
#[cfg_attr(not(target_arch = "x86_64"), expect(dead_code, reason = "the smaller tables are for registers of x86"))]
pub struct BitMatrix {
    pub(crate) by_three: [[u32; 8]; 11],
    pub(crate) by_four: [[u32; 16]; 8],
    pub(crate) by_eight: [[u32; 256]; 4],
}

/// Tables of the products with `BITS` bits at a time.
const fn tables<const SIZE: usize, const COUNT: usize>(columns: &[u32; 32]) -> [[u32; SIZE]; COUNT] {
    let bits = SIZE.trailing_zeros() as usize;
    let mut tables = [[0; SIZE]; COUNT];
    let mut table = 0;
    while table < COUNT {
        let mut value = 0;
        while value < SIZE {
            let mut bit = 0;
            while bit < bits {
                if (value >> bit) & 1 == 1 && bits * table + bit < 32 {
                    tables[table][value] ^= columns[bits * table + bit];
                }
                bit += 1;
            }
            value += 1;
        }
        table += 1;
    }
    tables
}

impl BitMatrix {
    /// The matrix whose column `i` is what bit `i` of a factor adds to the product.
    pub const fn new(columns: &[u32; 32]) -> Self {
        BitMatrix { by_three: tables(columns), by_four: tables(columns), by_eight: tables(columns) }
    }

    /// The product with the bits of `factor`.
    #[inline(always)]
    pub fn times(&self, factor: u32) -> u32 {
        let [a, b, c, d] = factor.to_le_bytes().map(usize::from);
        self.by_eight[0][a] ^ self.by_eight[1][b] ^ self.by_eight[2][c] ^ self.by_eight[3][d]
    }
}
