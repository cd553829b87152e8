//! The machinery behind [`Quality`](super::Quality): one definition of each setting, from which flags, JSON keys, the
//! viewer's list, the check of the C struct and docs/settings.md follow.

use super::Quality;
use crate::{Error, Result};
use std::ops::RangeInclusive;

/// A setting of [`Quality`](super::Quality).
pub struct Setting {
    /// Name in plans, JSON and C. A flag writes `-` for `_`.
    pub name: &'static str,
    /// Who needs it.
    pub audience: Audience,
    /// Values that it takes.
    pub values: Values,
    pub(super) doc: &'static str,
    pub(super) get: fn(&Quality) -> String,
    pub(super) set: fn(&mut Quality, &str) -> Option<()>,
}

/// Who needs a setting.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Audience {
    /// Everyone: on the first screen of help.
    Everyone,
    /// Users who compare methods.
    Advanced,
    /// Users who measure the methods themselves.
    Expert,
}

/// Values that a setting takes.
#[derive(Clone, Debug)]
pub enum Values {
    /// Whole numbers.
    Whole(RangeInclusive<u32>),
    /// These numbers.
    OneOf(&'static [u32]),
    /// A share from 0 to 1.
    Share,
    /// One of these words.
    Words(&'static [Word]),
}

/// A word that a setting takes.
#[derive(Clone, Copy, Debug)]
pub struct Word {
    /// The word.
    pub name: &'static str,
    doc: &'static str,
}

impl Word {
    pub(super) const fn new(name: &'static str, doc: &'static str) -> Self {
        Self { name, doc }
    }

    /// One sentence on it.
    pub fn summary(&self) -> String {
        paragraph(self.doc, 0)
    }
}

impl Setting {
    /// One sentence on the setting.
    pub fn summary(&self) -> String {
        paragraph(self.doc, 0)
    }

    /// What gets worse either way; may be empty.
    pub fn trade(&self) -> String {
        paragraph(self.doc, 1)
    }

    /// Its value.
    pub fn get(&self, quality: &Quality) -> String {
        (self.get)(quality)
    }

    /// Sets its value.
    ///
    /// # Errors
    /// A value that it does not take.
    pub fn set(&self, quality: &mut Quality, value: &str) -> Result<()> {
        let has_set = self.values.take(value).then(|| (self.set)(quality, value)).flatten();
        has_set.ok_or_else(|| Error::setting(self.name, value, self.values.expected()))
    }

    pub(super) fn check(&self, quality: &Quality) -> Result<()> {
        let value = self.get(quality);
        match self.values.take(&value) {
            true => Ok(()),
            false => Err(Error::setting(self.name, value, self.values.expected())),
        }
    }
}

impl Values {
    fn take(&self, value: &str) -> bool {
        let whole = || value.parse::<u32>().ok();
        match self {
            Values::Whole(range) => whole().is_some_and(|n| range.contains(&n)),
            Values::OneOf(all) => whole().is_some_and(|n| all.contains(&n)),
            Values::Share => value.parse::<f64>().is_ok_and(|share| (0.0..=1.0).contains(&share)),
            Values::Words(all) => all.iter().any(|word| word.name == value),
        }
    }

    /// What an error says was expected.
    pub fn expected(&self) -> String {
        let list = |all: Vec<String>| match all.split_last() {
            Some((last, rest)) if !rest.is_empty() => format!("{} or {last}", rest.join(", ")),
            _ => all.concat(),
        };
        match self {
            Values::Whole(range) => {
                format!("a whole number from {} to {}", range.start(), range.end())
            }
            Values::OneOf(all) => list(all.iter().map(u32::to_string).collect()),
            Values::Share => "a share from 0 to 1".into(),
            Values::Words(all) => list(all.iter().map(|word| word.name.to_owned()).collect()),
        }
    }
}

/// The nth paragraph of a doc comment, in one line.
fn paragraph(doc: &str, n: usize) -> String {
    let text: Vec<&str> = doc.lines().map(str::trim).collect();
    let part = text.split(|line| line.is_empty()).filter(|lines| !lines.is_empty()).nth(n);
    part.map(|lines| lines.join(" ")).unwrap_or_default()
}

/// A value whose [`Display`](std::fmt::Display) can be read again.
pub(super) trait Text: Sized {
    fn parse(text: &str) -> Option<Self>;
}

impl Text for u32 {
    fn parse(text: &str) -> Option<Self> {
        text.parse().ok()
    }
}

impl Text for f64 {
    fn parse(text: &str) -> Option<Self> {
        text.parse().ok()
    }
}

/// An enum whose variants are words of a setting. The first paragraph of a variant's comment is its help.
macro_rules! words {
    (
        $(#[doc = $about:literal])*
        pub enum $Enum:ident = $default:ident {
            $( $(#[doc = $doc:literal])* $Variant:ident = $word:literal, )*
        }
    ) => {
        $(#[doc = $about])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum $Enum {
            $( $(#[doc = $doc])* $Variant, )*
        }

        impl $Enum {
            pub(super) const WORDS: Values = Values::Words(&[$(Word::new($word, concat!($($doc, "\n"),*))),*]);

            /// Its word on the command line and in JSON.
            pub(crate) fn name(self) -> &'static str {
                match self {
                    $( $Enum::$Variant => $word, )*
                }
            }
        }

        impl std::fmt::Display for $Enum {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.pad(self.name())
            }
        }

        impl Default for $Enum {
            fn default() -> Self {
                $Enum::$default
            }
        }

        impl Text for $Enum {
            fn parse(text: &str) -> Option<Self> {
                match text {
                    $( $word => Some($Enum::$Variant), )*
                    _ => None,
                }
            }
        }
    };
}

/// Structs of settings. Each field: audience, name, type, default and values. The first paragraph of its comment is its
/// help, the second what gets worse either way; others are for readers of the library's documentation.
macro_rules! settings {
    ($(
        $(#[doc = $about:literal])*
        pub struct $Struct:ident of $of:path, $(with $inner:ident: $Inner:ident,)? {
            $(
                $(#[doc = $doc:literal])*
                $Audience:ident $name:literal $field:ident: $Type:ty = $default:expr, $values:expr;
            )*
        }
    )*) => {
        $(
            $(#[doc = $about])*
            #[derive(Clone, Copy, Debug, PartialEq)]
            pub struct $Struct {
                $( $(#[doc = $doc])* pub $field: $Type, )*
                $(
                    #[doc = concat!("Settings of [`", stringify!($Inner), "`].")]
                    pub $inner: $Inner,
                )?
            }

            impl $Struct {
                /// All settings at their defaults.
                pub(crate) const DEFAULT: Self =
                    Self { $( $field: $default, )* $( $inner: $Inner::DEFAULT, )? };
            }

            impl Default for $Struct {
                fn default() -> Self {
                    Self::DEFAULT
                }
            }
        )*

        /// Every setting of [`Quality`], in the order of help.
        pub static SETTINGS: &[Setting] = &[$($(
            Setting {
                name: $name,
                audience: Audience::$Audience,
                values: $values,
                doc: concat!($($doc, "\n"),*),
                get: |quality| $of(&mut { *quality }).$field.to_string(),
                set: |quality, text| {
                    $of(quality).$field = Text::parse(text)?;
                    Some(())
                },
            },
        )*)*];
    };
}

pub(super) use {settings, words};
