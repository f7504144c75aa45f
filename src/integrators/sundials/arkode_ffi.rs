//! Declarations of ARKODE and of some functions more, which `sundials-sys` does not bind.
//!
//! They are kept here rather than generated as the crate is built, for which that would need bindgen and headers. Those of SUNDIALS 6.4 and 7 are the
//! same, except for functions that are marked; `tests/integrators/headers.rs` compares them with the headers that are installed. Callbacks of ARKODE have
//! the types of CVODES, which are the same, except for those with a mass matrix.

#![allow(non_camel_case_types, non_snake_case, non_upper_case_globals)]

use std::ffi::{c_char, c_int, c_long, c_void};

#[cfg(sundials_major = "6")]
use sundials_sys::CVErrHandlerFn;
use sundials_sys::{
    CVEwtFn, CVLsJacFn, CVLsJacTimesSetupFn, CVLsJacTimesVecFn, CVLsPrecSetupFn, CVLsPrecSolveFn,
    CVRhsFn, CVRootFn, FILE, N_Vector, SUNContext, SUNLinearSolver, SUNMatrix, SUNNonlinearSolver,
};

pub const ARK_NORMAL: c_int = 1;
pub const ARK_ONE_STEP: c_int = 2;
pub const ARK_INTERP_LAGRANGE: c_int = 1;
pub const ARK_ROOT_RETURN: c_int = 2;
pub const ARK_TOO_MUCH_WORK: c_int = -1;
pub const ARK_TOO_MUCH_ACC: c_int = -2;
pub const ARK_ERR_FAILURE: c_int = -3;
pub const ARK_CONV_FAILURE: c_int = -4;
pub const ARK_LINIT_FAIL: c_int = -5;
pub const ARK_LSETUP_FAIL: c_int = -6;
pub const ARK_LSOLVE_FAIL: c_int = -7;
pub const ARK_RHSFUNC_FAIL: c_int = -8;
pub const ARK_UNREC_RHSFUNC_ERR: c_int = -11;
pub const ARK_MASSSETUP_FAIL: c_int = -15;
pub const ARK_MASSSOLVE_FAIL: c_int = -16;
pub const ARK_ILL_INPUT: c_int = -22;
pub const ARK_BAD_K: c_int = -24;
pub const ARK_BAD_T: c_int = -25;
pub const ARK_TOO_CLOSE: c_int = -27;
pub const ARKODE_MIS_KW3: c_int = 200;
pub const ARKODE_MRI_GARK_ERK33a: c_int = 201;
pub const ARKODE_MRI_GARK_ERK45a: c_int = 202;
pub const ARKODE_MRI_GARK_IRK21a: c_int = 203;
pub const ARKODE_MRI_GARK_ESDIRK34a: c_int = 204;
pub const ARKODE_MRI_GARK_ESDIRK46a: c_int = 205;
pub const ARKODE_IMEX_MRI_GARK3a: c_int = 206;
pub const ARKODE_IMEX_MRI_GARK3b: c_int = 207;
pub const ARKODE_IMEX_MRI_GARK4: c_int = 208;

/// A Butcher table, always behind a pointer: its first member, the order, is the only one that is read.
#[repr(C)]
pub struct ARKodeButcherTableMem {
    pub q: c_int,
}
pub type ARKodeButcherTable = *mut ARKodeButcherTableMem;

#[repr(C)]
pub struct MRIStepCouplingMem([u8; 0]);
pub type MRIStepCoupling = *mut MRIStepCouplingMem;

#[repr(C)]
pub struct _MRIStepInnerStepper([u8; 0]);
pub type MRIStepInnerStepper = *mut _MRIStepInnerStepper;

pub type ARKAdaptFn = Option<
    unsafe extern "C" fn(
        y: N_Vector,
        t: f64,
        h1: f64,
        h2: f64,
        h3: f64,
        e1: f64,
        e2: f64,
        e3: f64,
        q: c_int,
        p: c_int,
        hnew: *mut f64,
        user_data: *mut c_void,
    ) -> c_int,
>;
pub type ARKExpStabFn = Option<
    unsafe extern "C" fn(y: N_Vector, t: f64, hstab: *mut f64, user_data: *mut c_void) -> c_int,
>;
pub type ARKPostProcessFn =
    Option<unsafe extern "C" fn(t: f64, y: N_Vector, user_data: *mut c_void) -> c_int>;
pub type ARKLsMassFn = Option<
    unsafe extern "C" fn(
        t: f64,
        M: SUNMatrix,
        user_data: *mut c_void,
        tmp1: N_Vector,
        tmp2: N_Vector,
        tmp3: N_Vector,
    ) -> c_int,
>;
pub type ARKLsLinSysFn = Option<
    unsafe extern "C" fn(
        t: f64,
        y: N_Vector,
        fy: N_Vector,
        A: SUNMatrix,
        M: SUNMatrix,
        jok: c_int,
        jcur: *mut c_int,
        gamma: f64,
        user_data: *mut c_void,
        tmp1: N_Vector,
        tmp2: N_Vector,
        tmp3: N_Vector,
    ) -> c_int,
>;

unsafe extern "C" {
    pub fn ARKodeButcherTable_Create(
        s: c_int,
        q: c_int,
        p: c_int,
        c: *mut f64,
        A: *mut f64,
        b: *mut f64,
        d: *mut f64,
    ) -> ARKodeButcherTable;
    pub fn ARKodeButcherTable_Free(B: ARKodeButcherTable);
    pub fn ARKodeButcherTable_CheckOrder(
        B: ARKodeButcherTable,
        q: *mut c_int,
        p: *mut c_int,
        outfile: *mut FILE,
    ) -> c_int;
    pub fn ARKodeButcherTable_CheckARKOrder(
        B1: ARKodeButcherTable,
        B2: ARKodeButcherTable,
        q: *mut c_int,
        p: *mut c_int,
        outfile: *mut FILE,
    ) -> c_int;
    pub fn ARKStepCreate(
        fe: CVRhsFn,
        fi: CVRhsFn,
        t0: f64,
        y0: N_Vector,
        sunctx: SUNContext,
    ) -> *mut c_void;
    pub fn ARKStepReInit(
        memory: *mut c_void,
        fe: CVRhsFn,
        fi: CVRhsFn,
        t0: f64,
        y0: N_Vector,
    ) -> c_int;
    pub fn ARKStepReset(memory: *mut c_void, tR: f64, yR: N_Vector) -> c_int;
    pub fn ARKStepSStolerances(memory: *mut c_void, reltol: f64, abstol: f64) -> c_int;
    pub fn ARKStepSVtolerances(memory: *mut c_void, reltol: f64, abstol: N_Vector) -> c_int;
    pub fn ARKStepWFtolerances(memory: *mut c_void, efun: CVEwtFn) -> c_int;
    pub fn ARKStepSetLinearSolver(memory: *mut c_void, LS: SUNLinearSolver, A: SUNMatrix) -> c_int;
    pub fn ARKStepSetMassLinearSolver(
        memory: *mut c_void,
        LS: SUNLinearSolver,
        M: SUNMatrix,
        time_dep: c_int,
    ) -> c_int;
    pub fn ARKStepRootInit(memory: *mut c_void, nrtfn: c_int, g: CVRootFn) -> c_int;
    pub fn ARKStepSetInterpolantType(memory: *mut c_void, itype: c_int) -> c_int;
    pub fn ARKStepSetInterpolantDegree(memory: *mut c_void, degree: c_int) -> c_int;
    pub fn ARKStepSetNonlinearSolver(memory: *mut c_void, NLS: SUNNonlinearSolver) -> c_int;
    pub fn ARKStepSetNlsRhsFn(memory: *mut c_void, nls_fi: CVRhsFn) -> c_int;
    pub fn ARKStepSetLinear(memory: *mut c_void, timedepend: c_int) -> c_int;
    pub fn ARKStepSetDeduceImplicitRhs(memory: *mut c_void, deduce: c_int) -> c_int;
    pub fn ARKStepSetTables(
        memory: *mut c_void,
        q: c_int,
        p: c_int,
        Bi: ARKodeButcherTable,
        Be: ARKodeButcherTable,
    ) -> c_int;
    pub fn ARKStepSetTableName(
        memory: *mut c_void,
        itable: *const c_char,
        etable: *const c_char,
    ) -> c_int;
    pub fn ARKStepSetSafetyFactor(memory: *mut c_void, safety: f64) -> c_int;
    pub fn ARKStepSetErrorBias(memory: *mut c_void, bias: f64) -> c_int;
    pub fn ARKStepSetMaxGrowth(memory: *mut c_void, mx_growth: f64) -> c_int;
    pub fn ARKStepSetMinReduction(memory: *mut c_void, eta_min: f64) -> c_int;
    pub fn ARKStepSetFixedStepBounds(memory: *mut c_void, lb: f64, ub: f64) -> c_int;
    pub fn ARKStepSetAdaptivityMethod(
        memory: *mut c_void,
        imethod: c_int,
        idefault: c_int,
        pq: c_int,
        adapt_params: *mut f64,
    ) -> c_int;
    pub fn ARKStepSetAdaptivityFn(
        memory: *mut c_void,
        hfun: ARKAdaptFn,
        h_data: *mut c_void,
    ) -> c_int;
    pub fn ARKStepSetMaxFirstGrowth(memory: *mut c_void, etamx1: f64) -> c_int;
    pub fn ARKStepSetMaxEFailGrowth(memory: *mut c_void, etamxf: f64) -> c_int;
    pub fn ARKStepSetMaxCFailGrowth(memory: *mut c_void, etacf: f64) -> c_int;
    pub fn ARKStepSetLSetupFrequency(memory: *mut c_void, msbp: c_int) -> c_int;
    pub fn ARKStepSetPredictorMethod(memory: *mut c_void, method: c_int) -> c_int;
    pub fn ARKStepSetStabilityFn(
        memory: *mut c_void,
        EStab: ARKExpStabFn,
        estab_data: *mut c_void,
    ) -> c_int;
    pub fn ARKStepSetMaxErrTestFails(memory: *mut c_void, maxnef: c_int) -> c_int;
    pub fn ARKStepSetMaxNonlinIters(memory: *mut c_void, maxcor: c_int) -> c_int;
    pub fn ARKStepSetNonlinConvCoef(memory: *mut c_void, nlscoef: f64) -> c_int;
    pub fn ARKStepSetConstraints(memory: *mut c_void, constraints: N_Vector) -> c_int;
    pub fn ARKStepSetMaxNumSteps(memory: *mut c_void, mxsteps: c_long) -> c_int;
    pub fn ARKStepSetInitStep(memory: *mut c_void, hin: f64) -> c_int;
    pub fn ARKStepSetMinStep(memory: *mut c_void, hmin: f64) -> c_int;
    pub fn ARKStepSetMaxStep(memory: *mut c_void, hmax: f64) -> c_int;
    pub fn ARKStepSetStopTime(memory: *mut c_void, tstop: f64) -> c_int;
    pub fn ARKStepSetFixedStep(memory: *mut c_void, hfixed: f64) -> c_int;
    pub fn ARKStepSetNoInactiveRootWarn(memory: *mut c_void) -> c_int;
    #[cfg(sundials_major = "6")]
    pub fn ARKStepSetErrHandlerFn(
        memory: *mut c_void,
        ehfun: CVErrHandlerFn,
        eh_data: *mut c_void,
    ) -> c_int;
    pub fn ARKStepSetUserData(memory: *mut c_void, user_data: *mut c_void) -> c_int;
    pub fn ARKStepSetPostprocessStepFn(memory: *mut c_void, ProcessStep: ARKPostProcessFn)
    -> c_int;
    pub fn ARKStepSetJacFn(memory: *mut c_void, jac: CVLsJacFn) -> c_int;
    pub fn ARKStepSetMassFn(memory: *mut c_void, mass: ARKLsMassFn) -> c_int;
    pub fn ARKStepSetJacEvalFrequency(memory: *mut c_void, msbj: c_long) -> c_int;
    pub fn ARKStepSetEpsLin(memory: *mut c_void, eplifac: f64) -> c_int;
    pub fn ARKStepSetPreconditioner(
        memory: *mut c_void,
        psetup: CVLsPrecSetupFn,
        psolve: CVLsPrecSolveFn,
    ) -> c_int;
    pub fn ARKStepSetJacTimes(
        memory: *mut c_void,
        jtsetup: CVLsJacTimesSetupFn,
        jtimes: CVLsJacTimesVecFn,
    ) -> c_int;
    pub fn ARKStepSetLinSysFn(memory: *mut c_void, linsys: ARKLsLinSysFn) -> c_int;
    pub fn ARKStepEvolve(
        memory: *mut c_void,
        tout: f64,
        yout: N_Vector,
        tret: *mut f64,
        itask: c_int,
    ) -> c_int;
    pub fn ARKStepGetDky(memory: *mut c_void, t: f64, k: c_int, dky: N_Vector) -> c_int;
    pub fn ARKStepGetNumRhsEvals(
        memory: *mut c_void,
        nfe_evals: *mut c_long,
        nfi_evals: *mut c_long,
    ) -> c_int;
    pub fn ARKStepGetNumLinSolvSetups(memory: *mut c_void, nlinsetups: *mut c_long) -> c_int;
    pub fn ARKStepGetNumErrTestFails(memory: *mut c_void, netfails: *mut c_long) -> c_int;
    pub fn ARKStepGetCurrentButcherTables(
        memory: *mut c_void,
        Bi: *mut ARKodeButcherTable,
        Be: *mut ARKodeButcherTable,
    ) -> c_int;
    pub fn ARKStepGetCurrentStep(memory: *mut c_void, hcur: *mut f64) -> c_int;
    pub fn ARKStepGetCurrentGamma(memory: *mut c_void, gamma: *mut f64) -> c_int;
    pub fn ARKStepGetTolScaleFactor(memory: *mut c_void, tolsfac: *mut f64) -> c_int;
    pub fn ARKStepGetErrWeights(memory: *mut c_void, eweight: N_Vector) -> c_int;
    pub fn ARKStepGetNumGEvals(memory: *mut c_void, ngevals: *mut c_long) -> c_int;
    pub fn ARKStepGetRootInfo(memory: *mut c_void, rootsfound: *mut c_int) -> c_int;
    pub fn ARKStepGetStepStats(
        memory: *mut c_void,
        nsteps: *mut c_long,
        hinused: *mut f64,
        hlast: *mut f64,
        hcur: *mut f64,
        tcur: *mut f64,
    ) -> c_int;
    pub fn ARKStepGetNonlinSolvStats(
        memory: *mut c_void,
        nniters: *mut c_long,
        nnfails: *mut c_long,
    ) -> c_int;
    pub fn ARKStepGetNumStepSolveFails(memory: *mut c_void, nncfails: *mut c_long) -> c_int;
    pub fn ARKStepGetNumJacEvals(memory: *mut c_void, njevals: *mut c_long) -> c_int;
    pub fn ARKStepGetNumPrecEvals(memory: *mut c_void, npevals: *mut c_long) -> c_int;
    pub fn ARKStepGetNumPrecSolves(memory: *mut c_void, npsolves: *mut c_long) -> c_int;
    pub fn ARKStepGetNumLinIters(memory: *mut c_void, nliters: *mut c_long) -> c_int;
    pub fn ARKStepGetNumLinConvFails(memory: *mut c_void, nlcfails: *mut c_long) -> c_int;
    pub fn ARKStepGetNumLinRhsEvals(memory: *mut c_void, nfevalsLS: *mut c_long) -> c_int;
    pub fn ARKStepGetLastLinFlag(memory: *mut c_void, flag: *mut c_long) -> c_int;
    pub fn ARKStepFree(memory: *mut *mut c_void);
    pub fn ARKStepCreateMRIStepInnerStepper(
        memory: *mut c_void,
        stepper: *mut MRIStepInnerStepper,
    ) -> c_int;
    pub fn MRIStepCoupling_LoadTable(method: c_int) -> MRIStepCoupling;
    pub fn MRIStepCoupling_Free(MRIC: MRIStepCoupling);
    pub fn MRIStepCreate(
        fse: CVRhsFn,
        fsi: CVRhsFn,
        t0: f64,
        y0: N_Vector,
        stepper: MRIStepInnerStepper,
        sunctx: SUNContext,
    ) -> *mut c_void;
    pub fn MRIStepReInit(
        memory: *mut c_void,
        fse: CVRhsFn,
        fsi: CVRhsFn,
        t0: f64,
        y0: N_Vector,
    ) -> c_int;
    pub fn MRIStepReset(memory: *mut c_void, tR: f64, yR: N_Vector) -> c_int;
    pub fn MRIStepSStolerances(memory: *mut c_void, reltol: f64, abstol: f64) -> c_int;
    pub fn MRIStepSVtolerances(memory: *mut c_void, reltol: f64, abstol: N_Vector) -> c_int;
    pub fn MRIStepWFtolerances(memory: *mut c_void, efun: CVEwtFn) -> c_int;
    pub fn MRIStepSetLinearSolver(memory: *mut c_void, LS: SUNLinearSolver, A: SUNMatrix) -> c_int;
    pub fn MRIStepRootInit(memory: *mut c_void, nrtfn: c_int, g: CVRootFn) -> c_int;
    pub fn MRIStepSetInterpolantDegree(memory: *mut c_void, degree: c_int) -> c_int;
    pub fn MRIStepSetNonlinearSolver(memory: *mut c_void, NLS: SUNNonlinearSolver) -> c_int;
    pub fn MRIStepSetNlsRhsFn(memory: *mut c_void, nls_fs: CVRhsFn) -> c_int;
    pub fn MRIStepSetLinear(memory: *mut c_void, timedepend: c_int) -> c_int;
    pub fn MRIStepSetCoupling(memory: *mut c_void, MRIC: MRIStepCoupling) -> c_int;
    pub fn MRIStepSetMaxNumSteps(memory: *mut c_void, mxsteps: c_long) -> c_int;
    pub fn MRIStepSetLSetupFrequency(memory: *mut c_void, msbp: c_int) -> c_int;
    pub fn MRIStepSetPredictorMethod(memory: *mut c_void, method: c_int) -> c_int;
    pub fn MRIStepSetMaxNonlinIters(memory: *mut c_void, maxcor: c_int) -> c_int;
    pub fn MRIStepSetNonlinConvCoef(memory: *mut c_void, nlscoef: f64) -> c_int;
    pub fn MRIStepSetStopTime(memory: *mut c_void, tstop: f64) -> c_int;
    pub fn MRIStepSetFixedStep(memory: *mut c_void, hsfixed: f64) -> c_int;
    pub fn MRIStepSetNoInactiveRootWarn(memory: *mut c_void) -> c_int;
    #[cfg(sundials_major = "6")]
    pub fn MRIStepSetErrHandlerFn(
        memory: *mut c_void,
        ehfun: CVErrHandlerFn,
        eh_data: *mut c_void,
    ) -> c_int;
    pub fn MRIStepSetUserData(memory: *mut c_void, user_data: *mut c_void) -> c_int;
    pub fn MRIStepSetPostprocessStepFn(memory: *mut c_void, ProcessStep: ARKPostProcessFn)
    -> c_int;
    pub fn MRIStepSetDeduceImplicitRhs(memory: *mut c_void, deduce: c_int) -> c_int;
    pub fn MRIStepSetJacFn(memory: *mut c_void, jac: CVLsJacFn) -> c_int;
    pub fn MRIStepSetJacEvalFrequency(memory: *mut c_void, msbj: c_long) -> c_int;
    pub fn MRIStepSetEpsLin(memory: *mut c_void, eplifac: f64) -> c_int;
    pub fn MRIStepSetPreconditioner(
        memory: *mut c_void,
        psetup: CVLsPrecSetupFn,
        psolve: CVLsPrecSolveFn,
    ) -> c_int;
    pub fn MRIStepSetJacTimes(
        memory: *mut c_void,
        jtsetup: CVLsJacTimesSetupFn,
        jtimes: CVLsJacTimesVecFn,
    ) -> c_int;
    pub fn MRIStepSetLinSysFn(memory: *mut c_void, linsys: ARKLsLinSysFn) -> c_int;
    pub fn MRIStepEvolve(
        memory: *mut c_void,
        tout: f64,
        yout: N_Vector,
        tret: *mut f64,
        itask: c_int,
    ) -> c_int;
    pub fn MRIStepGetDky(memory: *mut c_void, t: f64, k: c_int, dky: N_Vector) -> c_int;
    pub fn MRIStepGetNumRhsEvals(
        memory: *mut c_void,
        nfse_evals: *mut c_long,
        nfsi_evals: *mut c_long,
    ) -> c_int;
    pub fn MRIStepGetNumLinSolvSetups(memory: *mut c_void, nlinsetups: *mut c_long) -> c_int;
    pub fn MRIStepGetNumSteps(memory: *mut c_void, nssteps: *mut c_long) -> c_int;
    pub fn MRIStepGetLastStep(memory: *mut c_void, hlast: *mut f64) -> c_int;
    pub fn MRIStepGetCurrentTime(memory: *mut c_void, tcur: *mut f64) -> c_int;
    pub fn MRIStepGetCurrentGamma(memory: *mut c_void, gamma: *mut f64) -> c_int;
    pub fn MRIStepGetTolScaleFactor(memory: *mut c_void, tolsfac: *mut f64) -> c_int;
    pub fn MRIStepGetErrWeights(memory: *mut c_void, eweight: N_Vector) -> c_int;
    pub fn MRIStepGetNumGEvals(memory: *mut c_void, ngevals: *mut c_long) -> c_int;
    pub fn MRIStepGetRootInfo(memory: *mut c_void, rootsfound: *mut c_int) -> c_int;
    pub fn MRIStepGetNonlinSolvStats(
        memory: *mut c_void,
        nniters: *mut c_long,
        nnfails: *mut c_long,
    ) -> c_int;
    pub fn MRIStepGetNumStepSolveFails(memory: *mut c_void, nncfails: *mut c_long) -> c_int;
    pub fn MRIStepGetNumJacEvals(memory: *mut c_void, njevals: *mut c_long) -> c_int;
    pub fn MRIStepGetNumPrecEvals(memory: *mut c_void, npevals: *mut c_long) -> c_int;
    pub fn MRIStepGetNumPrecSolves(memory: *mut c_void, npsolves: *mut c_long) -> c_int;
    pub fn MRIStepGetNumLinIters(memory: *mut c_void, nliters: *mut c_long) -> c_int;
    pub fn MRIStepGetNumLinConvFails(memory: *mut c_void, nlcfails: *mut c_long) -> c_int;
    pub fn MRIStepGetNumLinRhsEvals(memory: *mut c_void, nfevalsLS: *mut c_long) -> c_int;
    pub fn MRIStepGetLastLinFlag(memory: *mut c_void, flag: *mut c_long) -> c_int;
    pub fn MRIStepFree(memory: *mut *mut c_void);
    pub fn MRIStepInnerStepper_Free(stepper: *mut MRIStepInnerStepper) -> c_int;
    #[cfg(sundials_major = "6")]
    pub fn SUNDIALSGetVersion(version: *mut c_char, len: c_int) -> c_int;
    pub fn SuiteSparse_version(version: *mut c_int) -> c_int;
    #[cfg(not(feature = "vendored"))]
    pub fn SUNLinSol_KLU(y: N_Vector, A: SUNMatrix, sunctx: SUNContext) -> SUNLinearSolver;
    #[cfg(not(feature = "vendored"))]
    pub fn SUNLinSol_KLUSetOrdering(S: SUNLinearSolver, ordering_choice: c_int) -> c_int;
}
