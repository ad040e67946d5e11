//! Enumerations whose variants have a code, and maybe a name, on links and in traces: each variant is declared once.

/// Declares an enumeration of a number type: `Variant = code;`, or `Variant = code, "name";` for all of them.
#[macro_export]
macro_rules! codes {
    (
        $(#[$meta:meta])*
        $Name:ident: $number:ident { $($(#[$doc:meta])+ $variant:ident = $code:expr, $text:literal;)+ }
    ) => {
        $crate::codes! {
            $(#[$meta])*
            $Name: $number { $($(#[$doc])+ $variant = $code;)+ }
        }

        impl $Name {
            /// Name as it appears in text outputs.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $text,)+
                }
            }
        }
    };
    (
        $(#[$meta:meta])*
        $Name:ident: $number:ident { $($(#[$doc:meta])+ $variant:ident = $code:expr;)+ }
    ) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[repr($number)]
        pub enum $Name {
            $($(#[$doc])+ $variant = $code,)+
        }

        impl $Name {
            /// All of them, in the order of their codes.
            pub const ALL: [Self; [$(Self::$variant),+].len()] = [$(Self::$variant),+];

            /// The one with a code.
            #[must_use]
            pub fn from_code(code: $number) -> Option<Self> {
                Self::ALL.into_iter().find(|one| *one as $number == code)
            }
        }
    };
}
