//! The one function that prints numbers as Rust, and its traps: negative zero, and values that are not finite.

use proc_macro2::{Literal, TokenStream};
use quote::quote;

/// A finite number as Rust tokens that read back bit for bit.
///
/// # Panics
/// If the value is not finite: no derivation makes such a number.
pub fn number(value: f64) -> TokenStream {
    assert!(value.is_finite(), "a generated constant must be finite, not {value}");
    let literal = Literal::f64_unsuffixed(value.abs());
    if value.is_sign_negative() {
        quote! { -#literal }
    } else {
        quote! { #literal }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_back_exactly() {
        for value in [0.1, 1.0 / 3.0, 1e-300, -0.0, -std::f64::consts::PI, 2.0, f64::MAX, f64::MIN_POSITIVE] {
            let text = number(value).to_string().replace(' ', "");
            let back: f64 = text.parse().expect("a number");
            assert_eq!(back.to_bits(), value.to_bits(), "{text}");
        }
    }
}
