//! The macros by which keys are declared.

/// Keys as constants, their meaning being their documentation. A key that is not `optional` must be there, or has what stands behind
/// `or`.
macro_rules! keys {
    ($( $(#[doc = $means:literal])+ $name:ident = $key:literal, $kind:expr $(, $presence:ident $($default:expr)?)?; )+) => {
        $(
            $(#[doc = $means])+
            pub(crate) const $name: $crate::quantity::key::Key = $crate::quantity::key::Key {
                name: $key,
                means: concat!($($means),+),
                kind: $kind,
                presence: $crate::input::document::declare::keys!(@presence $kind $(, $presence $($default)?)?),
            };
        )+
    };
    (@presence $kind:expr) => { $crate::quantity::key::Presence::Required };
    (@presence $kind:expr, optional) => { $crate::quantity::key::Presence::Optional };
    (@presence $kind:expr, or $default:expr) => {
        $crate::quantity::key::Presence::Or(|| $crate::quantity::block::Field::written(&$default, &$kind))
    };
}
pub(in crate::input) use keys;

/// A key whose word decides which others its table has: the enum of its words, its key, and the keys that each word brings; those of a
/// block, where one is named.
macro_rules! choice {
    ($(#[doc = $means:literal])+ $row:ident = $key:literal, $name:ident, $others:ident:
        $( $(#[doc = $about:literal])* $variant:ident $(($block:ident))? $(= $word:literal: $keys:expr $(, $ways:expr)?)?; )+) => {
        contact_dma_core::words! {
            $(#[doc = $means])+
            pub(crate) enum $name {
                $( $(#[doc = $about])* $variant = $crate::input::document::declare::choice!(@word $($block)? $($word)?) ),+
            }
        }
        $crate::input::document::declare::keys! {
            $(#[doc = $means])+
            $row = $key, $crate::quantity::key::Kind::Word($name::WORDS);
        }
        const $others: $crate::quantity::rows::Others = $crate::quantity::rows::Others::ByWord(&$row, &[$(
            ($name::$variant.name(), $crate::input::document::declare::choice!(@rows $($block)? [$($about),*] $($keys $(, $ways)?)?))
        ),+]);
    };
    (@word $word:literal) => { $word };
    (@word $block:ident) => { <$block as $crate::quantity::block::Block>::NAME };
    (@rows $block:ident []) => { &<$block as $crate::quantity::block::Block>::ROWS };
    (@rows [$($about:literal),+] $keys:expr $(, $ways:expr)?) => {
        &$crate::quantity::rows::Rows {
            means: concat!($($about),+),
            keys: $keys,
            others: $crate::input::document::declare::choice!(@ways $($ways)?),
        }
    };
    (@ways) => { $crate::quantity::rows::Others::None };
    (@ways $ways:expr) => { $crate::quantity::rows::Others::OneList($ways) };
}
pub(in crate::input) use choice;
