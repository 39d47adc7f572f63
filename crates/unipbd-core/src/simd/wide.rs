//! Four lanes of f64: one vector of AVX2, two of SSE2, or an array. All give the same bits.
#![allow(unsafe_code)]

use super::Level;
use crate::math::Real;
use std::array::from_fn;
use std::ops::{Add, Div, Mul, Sub};

/// Lanes of a [`Wide`].
pub(crate) const WIDE: usize = 4;

/// Four numbers in the registers of one instruction set.
///
/// Values are made only by the unsafe functions, and their caller guarantees that the machine has the instruction set;
/// so the safe operations, which need a value, are sound.
pub(crate) trait Wide:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// Four numbers in a row.
    ///
    /// # Safety
    /// The machine has the instruction set.
    unsafe fn load(values: &[f64; WIDE]) -> Self;

    /// The same of the numbers of particles.
    ///
    /// # Safety
    /// The machine has the instruction set.
    #[inline(always)]
    unsafe fn load_real(values: &[Real; WIDE]) -> Self {
        let [p, q, r, s] = *values;
        // SAFETY: passed on to the caller.
        unsafe { Self::load(&[f64::from(p), f64::from(q), f64::from(r), f64::from(s)]) }
    }

    /// Four numbers in a row, as [`load`](Self::load): a value proves the instruction set.
    #[inline(always)]
    fn row(self, values: &[f64; WIDE]) -> Self {
        // SAFETY: a value of this type exists.
        unsafe { Self::load(values) }
    }

    /// The same of the numbers of particles.
    #[inline(always)]
    fn reals(self, values: &[Real; WIDE]) -> Self {
        // SAFETY: a value of this type exists.
        unsafe { Self::load_real(values) }
    }

    /// Columns of the rows with these numbers.
    #[inline(always)]
    fn gather(self, all: &[[f64; WIDE]], [p, q, r, s]: &[u32; WIDE]) -> [Self; WIDE] {
        let rows = [&all[*p as usize], &all[*q as usize], &all[*r as usize], &all[*s as usize]];
        // SAFETY: a value of this type exists.
        unsafe { Self::columns(rows) }
    }

    /// Puts the rows of these columns at these numbers.
    #[inline(always)]
    fn scatter(columns: [Self; WIDE], all: &mut [[f64; WIDE]], numbers: &[u32; WIDE]) {
        for (row, &number) in Self::rows(columns).into_iter().zip(numbers) {
            all[number as usize] = row;
        }
    }

    /// A constant.
    fn like(self, value: f64) -> Self;
    /// The exactly rounded square root.
    fn sqrt(self) -> Self;
    /// `self` where it is greater than `other`, else `other`.
    fn larger(self, other: Self) -> Self;
    /// `self` where it is less than `other`, else `other`.
    fn smaller(self, other: Self) -> Self;
    /// `yes` where `self < limit`, else `no`.
    fn where_below(self, limit: Self, yes: Self, no: Self) -> Self;
    /// The four numbers.
    fn to_array(self) -> [f64; WIDE];

    /// The four numbers as those of particles.
    #[inline(always)]
    fn to_reals(self) -> [Real; WIDE] {
        let [p, q, r, s] = self.to_array();
        [p as Real, q as Real, r as Real, s as Real]
    }

    /// Columns of the four rows.
    ///
    /// # Safety
    /// The machine has the instruction set.
    #[inline(always)]
    unsafe fn columns(rows: [&[f64; WIDE]; WIDE]) -> [Self; WIDE] {
        let [p, q, r, s] = rows;
        // SAFETY: passed on to the caller.
        unsafe {
            [
                Self::load(&[p[0], q[0], r[0], s[0]]),
                Self::load(&[p[1], q[1], r[1], s[1]]),
                Self::load(&[p[2], q[2], r[2], s[2]]),
                Self::load(&[p[3], q[3], r[3], s[3]]),
            ]
        }
    }

    /// Rows of the four columns.
    #[inline(always)]
    fn rows(columns: [Self; WIDE]) -> [[f64; WIDE]; WIDE] {
        let [x, y, z, w] = columns;
        let (x, y, z, w) = (x.to_array(), y.to_array(), z.to_array(), w.to_array());
        [[x[0], y[0], z[0], w[0]], [x[1], y[1], z[1], w[1]], [x[2], y[2], z[2], w[2]], [x[3], y[3], z[3], w[3]]]
    }
}

/// Code for the lanes of any instruction set; it must be inlined, and no closure in it handles lanes: a closure has not
/// the instruction set of the function around it.
pub(crate) trait Kernel {
    /// Runs it; `lanes` is a value of no meaning.
    fn run<W: Wide>(self, lanes: W);
}

/// Runs code in the lanes of the chosen instruction set.
pub(crate) fn run(kernel: impl Kernel) {
    match Level::best() {
        #[cfg(target_arch = "x86_64")]
        // SAFETY: the level runs on this machine.
        Level::Avx512 | Level::Avx2 => unsafe { run_avx2(kernel) },
        #[cfg(target_arch = "x86_64")]
        // SAFETY: SSE2 is in the baseline.
        Level::Sse2 => kernel.run(unsafe { Sse2::load(&[0.0; WIDE]) }),
        _ => kernel.run(Array([0.0; WIDE])),
    }
}

/// # Safety
/// The machine has AVX2.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
unsafe fn run_avx2(kernel: impl Kernel) {
    // SAFETY: the caller vouches for AVX2.
    kernel.run(unsafe { Avx2::load(&[0.0; WIDE]) });
}

/// An array of four.
#[derive(Clone, Copy)]
pub(crate) struct Array([f64; WIDE]);

macro_rules! lane_by_lane {
    ($($operation:ident $name:ident)*) => {$(
        impl $operation for Array {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                Array(from_fn(|k| self.0[k].$name(other.0[k])))
            }
        }
    )*};
}
lane_by_lane!(Add add Sub sub Mul mul Div div);

impl Wide for Array {
    #[inline(always)]
    unsafe fn load(values: &[f64; WIDE]) -> Self {
        Array(*values)
    }
    #[inline(always)]
    fn like(self, value: f64) -> Self {
        Array([value; WIDE])
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Array(self.0.map(f64::sqrt))
    }
    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        Array(from_fn(|k| if self.0[k] > other.0[k] { self.0[k] } else { other.0[k] }))
    }
    #[inline(always)]
    fn smaller(self, other: Self) -> Self {
        Array(from_fn(|k| if self.0[k] < other.0[k] { self.0[k] } else { other.0[k] }))
    }
    #[inline(always)]
    fn where_below(self, limit: Self, yes: Self, no: Self) -> Self {
        Array(from_fn(|k| if self.0[k] < limit.0[k] { yes.0[k] } else { no.0[k] }))
    }
    #[inline(always)]
    fn to_array(self) -> [f64; WIDE] {
        self.0
    }
}

#[cfg(target_arch = "x86_64")]
pub(crate) use x86::{Avx2, Sse2};

#[cfg(target_arch = "x86_64")]
mod x86 {
    use super::{WIDE, Wide};
    use std::arch::x86_64::*;
    use std::ops::{Add, Div, Mul, Sub};

    /// Two vectors of two.
    #[derive(Clone, Copy)]
    pub(crate) struct Sse2(__m128d, __m128d);

    /// One vector of four.
    #[derive(Clone, Copy)]
    pub(crate) struct Avx2(__m256d);

    macro_rules! operations {
        ($($operation:ident $name:ident $half:ident $whole:ident)*) => {$(
            impl $operation for Sse2 {
                type Output = Self;
                #[inline(always)]
                fn $name(self, other: Self) -> Self {
                    // SAFETY: SSE2 is in the baseline.
                    unsafe { Sse2($half(self.0, other.0), $half(self.1, other.1)) }
                }
            }
            impl $operation for Avx2 {
                type Output = Self;
                #[inline(always)]
                fn $name(self, other: Self) -> Self {
                    // SAFETY: a value of this type proves AVX2.
                    unsafe { Avx2($whole(self.0, other.0)) }
                }
            }
        )*};
    }
    operations!(
        Add add _mm_add_pd _mm256_add_pd
        Sub sub _mm_sub_pd _mm256_sub_pd
        Mul mul _mm_mul_pd _mm256_mul_pd
        Div div _mm_div_pd _mm256_div_pd
    );

    #[inline(always)]
    fn select(mask: __m128d, yes: __m128d, no: __m128d) -> __m128d {
        // SAFETY: SSE2 is in the baseline.
        unsafe { _mm_or_pd(_mm_and_pd(mask, yes), _mm_andnot_pd(mask, no)) }
    }

    impl Wide for Sse2 {
        #[inline(always)]
        unsafe fn load(values: &[f64; WIDE]) -> Self {
            // SAFETY: both loads are within the array and ask for no alignment; SSE2 is in the baseline.
            unsafe { Sse2(_mm_loadu_pd(values.as_ptr()), _mm_loadu_pd(values.as_ptr().add(2))) }
        }
        #[inline(always)]
        fn like(self, value: f64) -> Self {
            // SAFETY: SSE2 is in the baseline.
            unsafe { Sse2(_mm_set1_pd(value), _mm_set1_pd(value)) }
        }
        #[inline(always)]
        fn sqrt(self) -> Self {
            // SAFETY: SSE2 is in the baseline.
            unsafe { Sse2(_mm_sqrt_pd(self.0), _mm_sqrt_pd(self.1)) }
        }
        #[inline(always)]
        fn larger(self, other: Self) -> Self {
            // SAFETY: SSE2 is in the baseline.
            unsafe { Sse2(_mm_max_pd(self.0, other.0), _mm_max_pd(self.1, other.1)) }
        }
        #[inline(always)]
        fn smaller(self, other: Self) -> Self {
            // SAFETY: SSE2 is in the baseline.
            unsafe { Sse2(_mm_min_pd(self.0, other.0), _mm_min_pd(self.1, other.1)) }
        }
        #[inline(always)]
        fn where_below(self, limit: Self, yes: Self, no: Self) -> Self {
            // SAFETY: SSE2 is in the baseline.
            let (low, high) = unsafe { (_mm_cmplt_pd(self.0, limit.0), _mm_cmplt_pd(self.1, limit.1)) };
            Sse2(select(low, yes.0, no.0), select(high, yes.1, no.1))
        }
        #[inline(always)]
        fn to_array(self) -> [f64; WIDE] {
            let mut out = [0.0; WIDE];
            // SAFETY: both stores are within the array and ask for no alignment.
            unsafe {
                _mm_storeu_pd(out.as_mut_ptr(), self.0);
                _mm_storeu_pd(out.as_mut_ptr().add(2), self.1);
            }
            out
        }
    }

    /// The transposed matrix.
    ///
    /// # Safety
    /// The machine has AVX2.
    #[inline(always)]
    unsafe fn transposed([a, b, c, d]: [__m256d; WIDE]) -> [__m256d; WIDE] {
        // SAFETY: the caller vouches for AVX2.
        unsafe {
            let (ab, ab_high) = (_mm256_unpacklo_pd(a, b), _mm256_unpackhi_pd(a, b));
            let (cd, cd_high) = (_mm256_unpacklo_pd(c, d), _mm256_unpackhi_pd(c, d));
            [
                _mm256_permute2f128_pd::<0x20>(ab, cd),
                _mm256_permute2f128_pd::<0x20>(ab_high, cd_high),
                _mm256_permute2f128_pd::<0x31>(ab, cd),
                _mm256_permute2f128_pd::<0x31>(ab_high, cd_high),
            ]
        }
    }

    impl Wide for Avx2 {
        #[inline(always)]
        unsafe fn load(values: &[f64; WIDE]) -> Self {
            // SAFETY: the load is within the array and asks for no alignment; the caller vouches for AVX2.
            unsafe { Avx2(_mm256_loadu_pd(values.as_ptr())) }
        }
        #[cfg(not(feature = "f64"))]
        #[inline(always)]
        unsafe fn load_real(values: &[f32; WIDE]) -> Self {
            // SAFETY: as for `load`.
            unsafe { Avx2(_mm256_cvtps_pd(_mm_loadu_ps(values.as_ptr()))) }
        }
        #[inline(always)]
        fn like(self, value: f64) -> Self {
            // SAFETY: a value of this type proves AVX2.
            unsafe { Avx2(_mm256_set1_pd(value)) }
        }
        #[inline(always)]
        fn sqrt(self) -> Self {
            // SAFETY: a value of this type proves AVX2.
            unsafe { Avx2(_mm256_sqrt_pd(self.0)) }
        }
        #[inline(always)]
        fn larger(self, other: Self) -> Self {
            // SAFETY: a value of this type proves AVX2.
            unsafe { Avx2(_mm256_max_pd(self.0, other.0)) }
        }
        #[inline(always)]
        fn smaller(self, other: Self) -> Self {
            // SAFETY: a value of this type proves AVX2.
            unsafe { Avx2(_mm256_min_pd(self.0, other.0)) }
        }
        #[inline(always)]
        fn where_below(self, limit: Self, yes: Self, no: Self) -> Self {
            // SAFETY: a value of this type proves AVX2.
            unsafe { Avx2(_mm256_blendv_pd(no.0, yes.0, _mm256_cmp_pd::<_CMP_LT_OQ>(self.0, limit.0))) }
        }
        #[inline(always)]
        fn to_array(self) -> [f64; WIDE] {
            let mut out = [0.0; WIDE];
            // SAFETY: the store is within the array and asks for no alignment; a value proves AVX2.
            unsafe { _mm256_storeu_pd(out.as_mut_ptr(), self.0) };
            out
        }
        #[cfg(not(feature = "f64"))]
        #[inline(always)]
        fn to_reals(self) -> [f32; WIDE] {
            let mut out = [0.0; WIDE];
            // SAFETY: the store is within the array and asks for no alignment; a value proves AVX2.
            unsafe { _mm_storeu_ps(out.as_mut_ptr(), _mm256_cvtpd_ps(self.0)) };
            out
        }
        #[inline(always)]
        unsafe fn columns(rows: [&[f64; WIDE]; WIDE]) -> [Self; WIDE] {
            // SAFETY: the loads are within the rows and ask for no alignment; the caller vouches for AVX2.
            unsafe {
                let [p, q, r, s] = rows;
                let (p, q) = (_mm256_loadu_pd(p.as_ptr()), _mm256_loadu_pd(q.as_ptr()));
                let (r, s) = (_mm256_loadu_pd(r.as_ptr()), _mm256_loadu_pd(s.as_ptr()));
                let [x, y, z, w] = transposed([p, q, r, s]);
                [Avx2(x), Avx2(y), Avx2(z), Avx2(w)]
            }
        }
        #[inline(always)]
        fn rows(columns: [Self; WIDE]) -> [[f64; WIDE]; WIDE] {
            let [x, y, z, w] = columns;
            // SAFETY: a value of this type proves AVX2.
            let [p, q, r, s] = unsafe { transposed([x.0, y.0, z.0, w.0]) };
            [Avx2(p).to_array(), Avx2(q).to_array(), Avx2(r).to_array(), Avx2(s).to_array()]
        }
    }
}
