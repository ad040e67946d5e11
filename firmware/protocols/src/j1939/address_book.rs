//! Who has which address: the last NAME that was claimed for each source address.
//!
//! A node that has just started knows nobody. It asks a sender that matters for its claim (`Node`).

use super::id::NULL;
use super::name::Name;

/// Number of addresses that a node can have.
const ADDRESSES: usize = NULL as usize;
/// The NAME of an address that nobody has claimed; as a NAME it would be no implement's.
const NOBODY: Name = Name(0);

/// The NAMEs by address.
#[derive(Clone, Debug)]
pub struct AddressBook {
    names: [Name; ADDRESSES],
}

impl Default for AddressBook {
    fn default() -> Self {
        Self {
            names: [NOBODY; ADDRESSES],
        }
    }
}

impl AddressBook {
    /// A node has claimed `address`, or says from the null address that it cannot claim one. It gives up the address
    /// that it had before.
    pub fn claimed(&mut self, address: u8, name: Name) {
        for known in &mut self.names {
            if *known == name {
                *known = NOBODY;
            }
        }
        if let Some(entry) = self.names.get_mut(usize::from(address)) {
            *entry = name;
        }
    }

    /// The NAME of the node that has claimed `address`.
    #[must_use]
    pub fn name(&self, address: u8) -> Option<Name> {
        let name = self.names.get(usize::from(address)).copied();
        name.filter(|&name| name != NOBODY)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_claim_counts_and_a_node_has_one_address() {
        let mut book = AddressBook::default();
        assert!((0..=255).all(|address| book.name(address).is_none()));
        let (first, second) = (Name(11), Name(12));
        book.claimed(0x26, first);
        book.claimed(0x26, second);
        assert_eq!(book.name(0x26), Some(second));
        book.claimed(0x27, second);
        assert_eq!((book.name(0x26), book.name(0x27)), (None, Some(second)));
        book.claimed(NULL, second);
        assert!((0..=255).all(|address| book.name(address).is_none()));
        book.claimed(255, first);
        assert!((0..=255).all(|address| book.name(address).is_none()));
    }
}
