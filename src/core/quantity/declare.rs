//! The macros by which keys are declared that belong to no [`block!`](crate::block): those of a file alone, and those of a struct that is made
//! of them by hand.

/// Keys as constants, their meaning being their documentation. A key that is not `optional` must be there, or has what stands behind
/// `or`.
#[macro_export]
macro_rules! keys {
    ($( $(#[doc = $means:literal])+ $name:ident = $key:literal, $kind:expr $(, $presence:ident $($default:expr)?)?; )+) => {
        $(
            $(#[doc = $means])+
            pub const $name: $crate::quantity::key::Key = $crate::quantity::key::Key {
                name: $key,
                means: concat!($($means),+),
                kind: $kind,
                presence: $crate::keys!(@presence $kind $(, $presence $($default)?)?),
            };
        )+
    };
    (@presence $kind:expr) => { $crate::quantity::key::Presence::Required };
    (@presence $kind:expr, optional) => { $crate::quantity::key::Presence::Optional };
    (@presence $kind:expr, or $default:expr) => {
        $crate::quantity::key::Presence::Or(|| $crate::quantity::block::Field::written(&$default, &$kind))
    };
}

/// A key whose word decides which others its table has: the enum of its words, its key, and the keys that each word brings; those of a
/// block, where one is named.
#[macro_export]
macro_rules! choice {
    ($(#[doc = $means:literal])+ $row:ident = $key:literal, $name:ident, $others:ident:
        $( $(#[doc = $about:literal])* $variant:ident $(($block:ident))? $(= $word:literal: $keys:expr $(, $ways:expr)?)?; )+) => {
        $crate::words! {
            $(#[doc = $means])+
            pub enum $name {
                $( $(#[doc = $about])* $variant = $crate::choice!(@word $($block)? $($word)?) ),+
            }
        }
        $crate::keys! {
            $(#[doc = $means])+
            $row = $key, $crate::quantity::key::Kind::Word($name::WORDS);
        }
        const $others: $crate::quantity::rows::Others = $crate::quantity::rows::Others::ByWord(&$row, &[$(
            ($name::$variant.name(), $crate::choice!(@rows $($block)? [$($about),*] $($keys $(, $ways)?)?))
        ),+]);
    };
    (@word $word:literal) => { $word };
    (@word $block:ident) => { <$block as $crate::quantity::block::Block>::NAME };
    (@rows $block:ident []) => { &<$block as $crate::quantity::block::Block>::ROWS };
    (@rows [$($about:literal),+] $keys:expr $(, $ways:expr)?) => {
        &$crate::quantity::rows::Rows {
            means: concat!($($about),+),
            keys: $keys,
            others: $crate::choice!(@ways $($ways)?),
        }
    };
    (@ways) => { $crate::quantity::rows::Others::None };
    (@ways $ways:expr) => { $crate::quantity::rows::Others::OneList($ways) };
}
