"""The options of comparisons for type checkers; written by `python -m espdiff._signatures`."""

from typing import Any, Dict, List, TypedDict, Union


class Options(TypedDict, total=False):
    """What **options of compare() and its like stands for; `espdiff.help_options()` explains them."""

    # all, backbone, ca, none
    align: str
    domains: str
    select: str
    source_select: str
    target_select: str
    leave_out: str
    assembly: str
    # auto, file, element
    radii: str
    # auto, parse, amber, charmm, tyl06, peoepb, swanson
    force_field: str
    ph: float
    ligand: Union[str, List[str]]
    # auto, files
    ligands: str
    same_protonation: bool
    cache: bool
    topology: str
    source_topology: str
    target_topology: str
    charges_from: str
    region: str
    region_within: float
    of: str
    patches: Dict[str, str]
    causes: Union[str, List[str]]
    scan: bool
    side_chains: int
    side_chain_seed: int
    fields: Dict[str, Any]
    patches_of: Union[str, List[str]]
    interface: str
    offset: str
    temperature: float
    trust_maps: bool
    require: float
    leave_out_turned: bool
    grid_spacing: float
    radius_scale: float
    isovalue: float
    cavities: bool
    project: bool
    # morph, deform
    method: str
    round_trip: bool
    max_step: float
    max_edge: float
    max_stretch: float
    # density, distance, gvf, gvf2
    deform_field: str
    distance_threshold: float
    gvf_weight: float
    gvf_tolerance: float
    gvf_max_sweeps: int
    # trilinear, tricubic
    interpolation: str
    # source, none
    rest_shape: str
    subdivide: bool
    sigma: float
    mu: float
    rho: float
    tangential_gain: float
    max_iterations: int
    min_displacement: float
    thesis: bool
    regularize_sigma: float
    regularize_mu: float
    regularize_rho: float
    regularize_tangential_gain: float
    regularize_max_iterations: int
    regularize_min_displacement: float
    # auto, pb, pme, coulomb, none
    potential: str
    # auto, own, box
    pme_cell: str
    # linear, nonlinear
    pb: str
    ionic_strength: float
    ion_radius: float
    solute_dielectric: float
    solvent_dielectric: float
    # molecular, vdw, gaussian
    dielectric_boundary: str
    probe_radius: float
    # edges, nine-point
    dielectric_smoothing: str
    gaussian_sigma: float
    # debye-hueckel, focus
    far_boundary: str
    pb_spacing: float
    pb_padding: float
    pb_tolerance: float
    pb_max_cycles: int
    # full, smooth
    pme_part: str
    pme_grid: str
    ewaldfactor: float
    pme_spline: int
    # single, double
    pme_precision: str
    pme_compatible: bool
    pme_pad: str
    dielectric: float
    distance_dependent: bool
    # auto, cpu, cuda, cuda:N
    device: str
    threads: int


class MatrixOptions(Options, total=False):
    """The same of matrix()."""

    cluster_by: str
    template: str
    exact_sample: int
    resume: bool
    overwrite: bool
    skip_errors: bool
    shard: str


class TrajectoryOptions(Options, total=False):
    """The same of trajectory()."""

    frames: str
    # auto, previous, source
    start: str
    residues: str
    residue_quantity: str
    resume: bool
    overwrite: bool
    skip_errors: bool
    # source, previous
    reference: str
    frames_of: str
    plugins: str
    source_model: int
    source_map: str
    target_map: str
    source_map_unit: str
    target_map_unit: str
    map_array: str


class EnsembleOptions(Options, total=False):
    """The same of ensemble()."""

    charges: Dict[str, str]
    maps: Dict[str, str]
    map_unit: str
    map_array: str
    frames: str
    template: str
    plugins: str
    resume: bool
    overwrite: bool
    skip_errors: bool
    shard: str
    from_file: str
    check_template: bool
    regress: str
    states: bool
    alpha: float
    # tfce, max-t
    control: str
    equilibration: str
    most_missing: float
    permutations: int
    seed: int
