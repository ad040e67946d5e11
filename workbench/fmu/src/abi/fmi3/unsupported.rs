//! What no unit supports. Each function refuses the call with a message and touches none of its arguments.

use std::ffi::c_int;

use super::types::Fmi3Boolean;
use crate::abi::guard::call;
use crate::abi::instance::Fault;
use crate::abi::types::{Handle, StateHandle, Status, ValueReference};

const NO_EVENTS: &str = "hasEventMode is false in modelDescription.xml";
const NO_EXCHANGE: &str = "the unit is for co-simulation alone";
const NO_STRUCTURE: &str = "the unit has no structural parameters";
const NO_CLOCKS: &str = "the unit has no clocks";
const NO_BINARIES: &str = "the unit has no binary variables";
const NO_ELEMENTS: &str = "providesPerElementDependencies is false in modelDescription.xml";
const NO_IMAGE: &str = "canSerializeFMUState is false in modelDescription.xml";
const NO_DIRECTIONAL: &str = "providesDirectionalDerivatives is false in modelDescription.xml";
const NO_ADJOINT: &str = "providesAdjointDerivatives is false in modelDescription.xml";
const NO_OUTPUT_DERIVATIVES: &str = "maxOutputDerivativeOrder is 0";

type References = *const ValueReference;
type Counts = *const u64;
type CountPlaces = *mut u64;
type Reals = *const f64;
type RealPlaces = *mut f64;
type Flag = *mut Fmi3Boolean;
type Bytes = *const u8;
type Kinds = *mut c_int;

/// Functions of the standard with the types of their arguments behind the instance, by the reason of the refusal.
macro_rules! refused {
    ($($reason:ident: $($name:ident($($type:ty),*))+;)*) => {$($(
        #[doc = concat!("Not supported: `", stringify!($name), "`.")]
        ///
        /// # Safety
        /// As the standard says: `instance` is an instance.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $name(instance: Handle, $(_: $type),*) -> Status {
            let refuse = |_: &mut _| Err(Fault::error(format!("is not supported: {}", $reason)));
            // SAFETY: the importer gives null or an instance, and calls one function at a time.
            unsafe { call(instance, stringify!($name), refuse) }
        }
    )+)*};
}

refused! {
    NO_EVENTS:
        fmi3EnterEventMode()
        fmi3EnterStepMode()
        fmi3EvaluateDiscreteStates()
        fmi3UpdateDiscreteStates(Flag, Flag, Flag, Flag, Flag, RealPlaces);
    NO_EXCHANGE:
        fmi3EnterContinuousTimeMode()
        fmi3CompletedIntegratorStep(Fmi3Boolean, Flag, Flag)
        fmi3SetTime(f64)
        fmi3SetContinuousStates(Reals, usize)
        fmi3GetContinuousStateDerivatives(RealPlaces, usize)
        fmi3GetEventIndicators(RealPlaces, usize)
        fmi3GetContinuousStates(RealPlaces, usize)
        fmi3GetNominalsOfContinuousStates(RealPlaces, usize)
        fmi3GetNumberOfEventIndicators(*mut usize)
        fmi3GetNumberOfContinuousStates(*mut usize)
        fmi3ActivateModelPartition(ValueReference, f64);
    NO_STRUCTURE:
        fmi3EnterConfigurationMode()
        fmi3ExitConfigurationMode();
    NO_CLOCKS:
        fmi3GetClock(References, usize, Flag)
        fmi3SetClock(References, usize, *const Fmi3Boolean)
        fmi3GetIntervalDecimal(References, usize, RealPlaces, Kinds)
        fmi3GetIntervalFraction(References, usize, CountPlaces, CountPlaces, Kinds)
        fmi3GetShiftDecimal(References, usize, RealPlaces)
        fmi3GetShiftFraction(References, usize, CountPlaces, CountPlaces)
        fmi3SetIntervalDecimal(References, usize, Reals)
        fmi3SetIntervalFraction(References, usize, Counts, Counts)
        fmi3SetShiftDecimal(References, usize, Reals)
        fmi3SetShiftFraction(References, usize, Counts, Counts);
    NO_BINARIES:
        fmi3GetBinary(References, usize, *mut usize, *mut Bytes, usize)
        fmi3SetBinary(References, usize, *const usize, *const Bytes, usize);
    NO_ELEMENTS:
        fmi3GetNumberOfVariableDependencies(ValueReference, *mut usize)
        fmi3GetVariableDependencies(ValueReference, *mut usize, *mut ValueReference, *mut usize, Kinds, usize);
    NO_IMAGE:
        fmi3SerializedFMUStateSize(StateHandle, *mut usize)
        fmi3SerializeFMUState(StateHandle, *mut u8, usize)
        fmi3DeserializeFMUState(Bytes, usize, *mut StateHandle);
    NO_DIRECTIONAL:
        fmi3GetDirectionalDerivative(References, usize, References, usize, Reals, usize, RealPlaces, usize);
    NO_ADJOINT:
        fmi3GetAdjointDerivative(References, usize, References, usize, Reals, usize, RealPlaces, usize);
    NO_OUTPUT_DERIVATIVES:
        fmi3GetOutputDerivatives(References, usize, *const i32, RealPlaces, usize);
}
