# commands.tcl: the table of all commands, from which dispatch, checks, help and the manual's second part are made.

# The keys of a command:
#   arguments  their names; ?name? is optional, ?name ...? takes any number
#   options    {-name kind default help ?choices? ?accepts?}; kinds as in options.tcl, default "required" marks required ones
#   settings   all, surface or none: the core::settings it takes as options
#   summary    one paragraph; returns: one sentence; example: a line or more
#   run        the procedure; called with the dict of options and the arguments
namespace eval ::espdiff {
    variable computing [concat [study_options computing] {
        {-progress command {} "Called as CMD stage fraction (0 to 1) about 20 times a second; `break` from it cancels"}
        {-command command {} "Compute in the background, and call CMD handle from the event loop at the end"}
    }]

    variable replacing {{-overwrite boolean 0 "Replace files that are there"}}

    command compare [dict create arguments {source target} options $computing settings all run ::espdiff::compare \
        summary {Maps the surface of the source onto that of the target, compares the potentials at corresponding
            points, and certifies the mapping. Source and target are endpoints. Without maps the potentials are
            computed (see Potentials); `map none` compares shapes alone.} \
        returns {a handle, such as comparison1. With -command at once, otherwise when the comparison is done} \
        example {espdiff compare {file wild.pqr map wild.dx} {file mutant.pqr map mutant.dx} -grid-spacing 0.8}]

    command prepare [dict create arguments {molecule} settings preparation run ::espdiff::prepare options [concat {
            {-pqr file required "PQR file to write: atoms with hydrogens, charges and radii"}
            {-progress command {} "Called as CMD stage fraction (0 to 1) about 20 times a second; `break` from it cancels"}
            {-command command {} "Prepare in the background, and call CMD handle from the event loop at the end"}
        } $replacing] \
        summary {Adds hydrogens, charges and radii to a molecule (an endpoint) by PDB2PQR, a program, with PROPKA's
            protonation states. Structures in files get the same wherever a potential is computed from them. Of a
            molecule in VMD, one location of each atom counts.} \
        returns {a handle, such as preparation1; `espdiff result` lists what was added, repaired and\
            protonated; `mol new` reads the file unless its `fits_pdb_columns` is 0} \
        example {espdiff prepare {mol 0 sel protein} -pqr prepared.pqr; mol new prepared.pqr}]

    command surface [dict create arguments {molecule} settings surface run ::espdiff::surface \
        options [concat $computing {{-regularize boolean 0 "Regularize the triangles"}}] \
        summary {Makes the surface of one molecule (an endpoint), with its potential if a map is given.} \
        returns {a handle, such as surface1} \
        example {espdiff surface {file wild.pqr map wild.dx} -regularize 1}]

    command result [dict create arguments {handle {?key ...?}} options {} settings none run ::espdiff::result \
        summary {The results, under the keys of the command line's OUT.json; further keys select from nested
            dictionaries. Missing values are empty strings.} \
        returns {a dictionary, or the value under the keys} \
        example {espdiff result comparison1 certificate trustworthy}]

    command residues [dict create arguments {handle} options {} settings none run ::espdiff::residues \
        summary {The comparison by residue of the source, over the mapped surface.} \
        returns "a list of dictionaries: index chain number insertion name, target_chain target_number target_insertion target_name (of its partner, or empty) [metric_names residues]" \
        example {foreach residue [espdiff residues comparison1] { puts [dict get $residue mean_abs_difference] }}]

    command table [dict create arguments {handle} options {} settings none run ::espdiff::table_of \
        summary {A comparison or a matrix as a readable table, as the command line prints it.} \
        returns {the text} example {puts [espdiff table comparison1]}]

    command export [dict create arguments {handle prefix} settings none run ::espdiff::export options [concat {
            {-inputs boolean 0 "For a comparison also its inputs: PREFIX.source.pqr and PREFIX.target.pqr as\
                compared, and maps from VMD as PREFIX.source_map.vti and PREFIX.target_map.vti"}
        } $replacing] \
        summary {Writes PREFIX.json (numbers, certificate, provenance), PREFIX.vtp (mapped surface, for ParaView) and
            PREFIX.residues.csv; for a surface only PREFIX.vtp. All files appear together or not at all.} \
        returns {the files written} example {espdiff export comparison1 wild_mutant}]

    command report [dict create arguments {result} settings none run ::espdiff::report options [concat {
            {-output file {} "Page to write; default: the result's name with .html"}
            {-title text {} "Heading; default: the names of both structures or groups, or of the result"}
            {-range-of text {} "One scale for a study: other results, handles or prefixes, whose automatic ranges count\
                too; the widest of all is taken"}
        } $replacing] \
        summary {Writes a result as one page for any browser, without network or other files: the surface to be turned,
            residues, numbers, verdict, provenance. The result is the handle of a comparison, matrix or ensemble, or the
            files of a result (prefix OUT, or OUT.csv of a trajectory).} \
        returns {the file} example {espdiff report comparison1 -output wild_mutant.html -title "Mutant"}]

    command map [dict create arguments {handle} settings none run ::espdiff::map options [concat {
            {-quantity choice difference "Quantity of the map" {difference source target sign slip
                displacement path_length}}
            {-spacing positive 1.0 "Distance of the lattice's points, Angstrom"}
            {-mol molecule {} "Add the map to this molecule of VMD, for `Color Volume` and Isosurface representations"}
            {-file file {} "Write the map to this DX file"}
        } $replacing] \
        summary {Writes a quantity of the mapped surface to a lattice around it. Give -mol or -file.} \
        returns {the number of the data set in the molecule, or the file} \
        example {espdiff map comparison1 -mol 1}]

    command atoms [dict create arguments {handle} settings none run ::espdiff::atoms options [concat \
        [list [list -quantity choice auto "Value for the atoms of a residue; auto is mean_abs_difference, or without\
            potentials mean_displacement_A; share: its part of the sum of |difference| times area over all residues;\
            contribution: what it adds to the first reading of -causes"\
            [concat auto share contribution [metric_names residues]]]] {
            {-mol text source "Molecule of VMD that gets the values: source, target, or an id"}
            {-field choice user "VMD's field: user to user4 hold one frame, the others all frames" {user
                user2 user3 user4 beta occupancy}}
            {-frame text now "Frame of a user field: a number, now, or all"}
            {-missing number 0 "Value of atoms whose residue has no valid surface"}
            {-file file {} "Instead of VMD: a PDB file of the source with the values as B factors"}
            {-show boolean 0 "Also colour the molecule's representations by the field, with a legend; 0 is in the middle\
                of VMD's colour scale; `espdiff uncolor` restores their colours"}
        } $replacing] \
        summary {Writes a quantity of the residues to their atoms, for colouring any representation
            (`Coloring Method` User or Beta), or to the B factors of a file for other programs. In the target's molecule
            a residue's value is on its partner.} \
        returns {a dictionary: quantity, unit, mol, field, atoms (number with a value), min, max; or the file} \
        example {espdiff atoms comparison1 -quantity mean_abs_difference -show 1}]

    command uncolor [dict create arguments {handle} options {} settings none run ::espdiff::uncolor \
        summary {Restores the colours of the representations that `espdiff atoms -show 1` coloured, and removes its
            legend. The field keeps its values.} \
        returns {nothing} example {espdiff uncolor comparison1}]

    command highlight [dict create arguments {handle residues} settings none run ::espdiff::highlight options {
            {-mol text both "Where: both, source, target (the comparison's molecules in VMD), or an id"}
            {-style text {VDW 2.0} "Representation and its parameters, as for `mol modstyle`; spheres of twice the\
                radius reach through the surface"}
            {-color text {ColorID 4} "Colouring method, as for `mol modcolor`; ColorID 4 is yellow"}
            {-face boolean 0 "Rotate the view so that they are in front"}
        } \
        summary {Highlights residues in VMD by a separate representation, which replaces the previous highlight; an
            empty list removes it. Residues are given by their `index` in `espdiff residues`. In the source's molecule
            they are found by their chain, number and insertion code, in the target's by those of their partners.} \
        returns {the molecules in which residues were found} \
        example {espdiff highlight comparison1 {88 113}}]

    command draw [dict create arguments {handle} settings none run ::espdiff::draw options {
            {-color choice auto "Quantity shown; auto is difference (for a surface, potential), or slip without\
                potentials. difference: target - source; sign: where it changed; slip: distance of each point from where its own atoms went; potential is for surfaces; path_length: length of each point's path,\
                at least its displacement; why: where it is trusted, and one colour for each reason why not"
                {auto difference sign source target potential slip displacement path_length why none}}
            {-field text "" "A field in the place of the potential: a name of `compute -field`; -color is difference,\
                sign, source or target of it (of an ensemble also t)"}
            {-range range auto "Values at the ends of the colour scale; auto is symmetric about 0 and covers 90 % of\
                the surface's points, as in the viewer and in pictures"}
            {-range-of text {} "One scale for a study: handles whose automatic ranges count too, so that -range auto is\
                the widest of all; with -view linked also for the potentials"}
            {-colors choice red-blue "Colours of signed values, from negative to positive; colour-blind\
                readers can distinguish the ends of each. cool-warm: blue to red, paler; purple-orange: where red and\
                blue stand for something else" {red-blue cool-warm purple-orange}}
            {-uncertain choice fade "fade: colours fade into grey the larger the slip; transparent: the\
                surface does; plain: full colours" {fade transparent plain}}
            {-uncertainty-limit positive 2.0 "Slip at which colours have faded completely, Angstrom; below half\
                of it nothing fades"}
            {-corrupt choice uncertain "Parts that are not trusted (the array why): faded like what is most uncertain,\
                marked in yellow, or not drawn"\
                {uncertain mark hide}}
            {-surface choice mapped "mapped: on the target; source: on the source" {mapped source}}
            {-legend boolean 1 "A colour bar with title and unit at the window's bottom"}
            {-keep boolean 0 "Keep the drawings of other handles; otherwise this one replaces them. Legends name their\
                comparison while there are several"}
            {-patch count 0 "Of an ensemble: the only patch that is not faded; 0 for all that is significant"}
            {-view choice single "linked: three surfaces side by side that the mouse rotates together, the source and\
                the target coloured by their potentials, the third on the target by -color; until `undraw` other\
                molecules are hidden and the projection is orthographic" {single linked}}
            {-potential-range range auto "For both potentials with -view linked; auto covers 90 % of the points of\
                each"}
        } \
        summary {Draws the surface in VMD in the place of the drawings that are there. Of an ensemble: the template with
            the difference of the groups (-color also source, target: means of the groups, and t), faded where it is
            not significant. Parts meet in smooth lines;
            unmatched parts are grey and hatched. View, top molecule and colour settings do not change. A
            drawing is up to four graphics molecules (eight in linked views), which are shown, hidden and deleted together.} \
        returns {the graphics molecules' ids} example {espdiff draw comparison1 -color difference -range {-5 5}}]

    command view [dict create arguments {input} settings none run ::espdiff::view options [concat \
        [study_options scene layout] {
            {-arguments text {} "Further options of the command line's `espdiff view`, a list such as {--molecule\
                cartoon --labels 8}"}
            {-output file {} "Prefix of pictures and scenes saved in the viewer; default: INPUT-view in the\
                working folder"}
        }] \
        summary {Starts espdiff's viewer, a separate program, with a comparison (its handle, or the exported
            PREFIX.vtp). For a handle, the viewer's inputs are written to a temporary folder, which is deleted when it
            ends. The viewer continues when VMD exits.} \
        returns {its process id} example {espdiff view comparison1 -layout linked}]

    command figure [dict create arguments {handle file} settings none run ::espdiff::figure \
        options [concat [study_options scene {width molecule title}] $replacing] \
        summary {Draws a comparison for print, as VMD shows it: VMD's camera and proportions, and the colours, range, fading and legend of the
            handle's drawing. It is drawn by espdiff's own renderer, which looks both maps up at every pixel, in a
            parallel projection.} \
        returns {the file} example {espdiff figure comparison1 figure1.png -width 2400}]

    command undraw [dict create arguments {{?handle ...?}} options {} settings none run ::espdiff::undraw \
        summary {Removes drawings with their legends; without a handle, all of them.} \
        returns {nothing} example {espdiff undraw comparison1}]

    command trajectory [dict create arguments {} settings all run ::espdiff::trajectory options [concat {
            {-mol molecule {} "Molecule of VMD whose frames are compared"}
            {-file file {} "Instead of -mol: structure file whose models are the frames, the first one is frame 0"}
            {-sel text "not water" "Atoms of the molecule; chosen once, in the reference frame"}
            {-reference text {frame 0} "What each frame is compared with: {frame N}, previous (the frame before it in\
                the run), an endpoint, or an endpoint with `frame same`: frame i with frame i of another trajectory,\
                such as {mol 1 frame same}"}
            {-map text auto "Potential of each frame; auto computes the usual one, none compares shapes alone,\
                {pme average N} is the mean of PME over N frames around it; see Trajectories"}
            {-reference-map text {} "Potential of the reference; without it by the rule of -map for its frame, or\
                computed as the frames' are"}
            {-unit text {} "Unit of the maps if they do not say: kT/e, mV, V, kcal/mol/e, kJ/mol/e, hartree/e"}
            {-whole boolean 0 "Make molecules whole that their periodic cell cuts; otherwise they are refused"}
            {-csv file required "File that gets one row for each frame"}
            {-callback command {} "Called as CMD frame row after each row, a dictionary by column; `break` cancels"}
        } [study_options trajectory] $computing] \
        summary {Compares each frame with the reference, or with the frame before, and writes a row for each as it is
            done. The reference's surface is computed once. An interrupted run can be resumed.} \
        returns {a dictionary: frames rows skipped resumed csv seconds; with -command a handle, such as trajectory1} \
        example {espdiff trajectory -mol 0 -frames 0:10:end -map {files frame%03d.dx} -csv out.csv}]

    command matrix [dict create arguments {variants} settings variants run ::espdiff::matrix options [concat {
            {-output file required "Prefix of the results OUT.csv and OUT.json, and of the state file"}
        } [study_options matrix] $computing] \
        summary {Compares many variants, each with each, in both directions. A variant is an endpoint that may have a
            `label` and a `group`; {mol ID frames FRAMES ...} stands for one variant per frame,
            {file PATH ...} without `model` for one per model. Each source's surface is regularized, and its
            potential computed, once.} \
        returns {a handle, such as matrix1; `espdiff result` has the content of OUT.json, and pairs, resumed, seconds,
            files} \
        example {espdiff matrix {{mol 0 frames 0:10:end map pme} {file open.pqr map pme group open}} -output adk}]

    command ensemble [dict create arguments {groups} settings variants run ::espdiff::ensemble options [concat {
            {-output file required "Prefix of the results: OUT.h5 (the potential of each frame), OUT.json, OUT.vtp,\
                OUT.residues.csv, OUT.patches.csv, OUT.patch_series.csv"}
            {-charges text {} "{GROUP FILE ...}: PQR files of the same atoms, whose charges and radii frames of files\
                take; without it, they keep their own, or PDB2PQR makes them from the group's first frame"}
            {-maps text {} "{GROUP PATTERN ...}: the potential of each frame, computed by another program, in the\
                frame's coordinates. %d or %03d in the pattern stands for the frame's number in its replicate, from 0,\
                {replicate} for the replicate's name"}
            {-map text auto "Potential of every frame: auto, pb, pme, coulomb, or with settings, such as\
                {pb ionic_strength 0.1}"}
        } [study_options ensemble] $computing] \
        summary {Compares two groups of simulations: where is the difference more than noise? One surface, the template,
            is mapped onto every frame, and each replicate is one sample. Groups are a list of a name and its
            replicates, once or twice. A replicate is {mol ID ?sel TEXT? ?frames FRAMES?}, {file PATH} (its models), or
            {file DCD topology PSF}; `label` names it. docs/ensembles.md explains the answer. Unlike in other commands,
            -max-step is 0.7 unless it is given.} \
        returns {a handle, such as ensemble1; `espdiff result` has the content of OUT.json, and frames, resumed,
            seconds, files} \
        example {espdiff ensemble {wild {{mol 0} {mol 1}} mutant {{mol 2} {mol 3}}} -output mutant}]

    command patches [dict create arguments {handle} settings none run ::espdiff::patches options {
            {-series boolean 0 "Also the mean of each patch in each frame, {group replicate frame value} under\
                `series`"}
        } \
        summary {The connected pieces of an ensemble's surface whose difference is significant, the largest first.} \
        returns {a list of dictionaries: patch area_A2 difference low high smallest_p peak_A residues} \
        example {foreach patch [espdiff patches ensemble1] { puts [dict get $patch area_A2] }}]

    command plot [dict create arguments {input} settings none run ::espdiff::plot options [concat {
            {-metrics text auto "Names of columns; auto is mean_abs_difference, or without potentials\
                mean_displacement_A"}
            {-source text {} "For a matrix: label of the variant to draw against all others (the\
                first one)"}
            {-normalize boolean 0 "Scale each metric from its minimum, 0, to its maximum, 1, all in one window"}
            {-title text {} "Title of the window's plot"}
            {-mol text top "For a trajectory: molecule that shows the frame of a clicked point; none for none"}
            {-callback command {} "Called instead as CMD x y with the frame or the variant's label, and the\
                value"}
            {-file file {} "Instead of VMD's windows: a picture, OUT.png or OUT.svg, drawn by gnuplot like the\
                command line's `espdiff plot`; hollow points are not trustworthy"}
        } $replacing] \
        summary {Plots a trajectory (its CSV file or handle), or one variant of a matrix (its handle) against all
            others, in VMD's own plot windows (package multiplot), a window for each unit, or into a file. Heat maps
            are drawn by the command line's `espdiff plot`.} \
        returns {a list of multiplot's handles, or the file} \
        example {espdiff plot out.csv -metrics {mean_abs_difference rmsd_A}}]

    command merge [dict create arguments {states} settings none run ::espdiff::merge options [concat {
            {-output file required "Prefix of the results: OUT.csv and OUT.json, or OUT.h5"}
        } [study_options merge]] \
        summary {Merges the parts of a matrix: the state files of `espdiff matrix -shard`, with -template the HDF5 files
            too; or of an ensemble: the files
            of `espdiff ensemble -shard`, whose statistics `espdiff ensemble {} -from OUT.h5` computes. The results are
            those of one process, byte by byte.} \
        returns {the files written} \
        example {espdiff merge [glob part.shard-*.state] -output all}]

    command potential [dict create arguments {} settings none run ::espdiff::potential options [concat {
            {-mol text top "Molecule of VMD"}
            {-sel text all "Atoms whose charges are included"}
            {-updatesel boolean 0 "Select again in each frame, instead of in the first only"}
            {-frames text now "now, all, a frame, begin:end or begin:step:end; see Frames"}
            {-variance boolean 0 "Also make the variance over the frames, as a data set or FILE.variance.dx"}
            {-error boolean 0 "Also make the standard error of the mean from the blocks, as a data set or\
                FILE.error.dx"}
            {-dxfile file {} "Write the mean to this DX file"}
            {-loadmol text same "Molecule that gets the maps as data sets: an id, same, new, or none"}
            {-progress command {} "Called as CMD stage fraction; `break` from it cancels"}
        } [study_options computing] [study_options potential] $replacing] \
        summary {Computes the electrostatic potential of a molecule's charges, by PME in the cell of each frame, or its
            mean over frames. Needs VMD; options shared with PMEPot have its names and meanings. A comparison does
            not need this command: `map pme` computes the maps itself.} \
        returns {a dictionary: frames, mol (the molecule with the maps), volumes (their numbers), files, seconds} \
        example {espdiff potential -mol 0 -frames all -align backbone -variance 1}]

    command status [dict create arguments {handle} options {} settings none run ::espdiff::status \
        summary {State and progress of a computation.} \
        returns {a dictionary: kind, state (queued, running, done, failed, cancelled), stage, fraction} \
        example {dict get [espdiff status comparison1] state}]

    command wait [dict create arguments {handle} settings none run ::espdiff::wait options {
            {-timeout count {} "Maximum time to wait, milliseconds; default: until the end"}
        } \
        summary {Waits for a computation in the background. If it failed, throws its error. Processes no
            events.} \
        returns {1, or 0 after the timeout} example {espdiff wait comparison1 -timeout 5000}]

    command cancel [dict create arguments {handle} options {} settings none run ::espdiff::cancel \
        summary {Cancels a computation in the background as soon as possible; finished results stay.} \
        returns {nothing} example {espdiff cancel trajectory1}]

    command delete [dict create arguments {{handle ...}} options {} settings none run ::espdiff::delete \
        summary {Frees handles with their drawings, and cancels running computations. `all` frees all. Deleting the
            interpreter also frees them.} \
        returns {nothing} example {espdiff delete comparison1 surface1}]

    command handles [dict create arguments {} options {} settings none run ::espdiff::handles \
        summary {All existing handles.} returns {a list} example {espdiff handles}]

    command device [dict create arguments {?name?} options {} settings none run ::espdiff::device \
        summary {Sets the default -device of later commands: auto, cpu, cuda, or cuda:N for the GPU of that index.
            Without a name, changes nothing. `espdiff doctor` lists the GPUs.} \
        returns {the name} \
        example {espdiff device cuda:1}]

    command doctor [dict create arguments {} options {} settings none run ::espdiff::doctor \
        summary {Lists what is installed, found, loaded and missing, with remedies.} \
        returns {the text} example {puts [espdiff doctor]}]

    command gui [dict create arguments {} options {} settings none run ::espdiff::open_window \
        summary {Opens the window (in VMD also Extensions > Analysis > Surface Potential Comparison). Needs Tk.} \
        returns {the window's path} example {espdiff gui}]

    command version [dict create arguments {} options {} settings none run ::espdiff::version \
        summary {The version of espdiff.} returns {the version} example {espdiff version}]

    command help [dict create arguments {?command?} options {} settings none run ::espdiff::help \
        summary {Lists the commands, or explains one; `espdiff COMMAND -help` is the same.} \
        returns {the text} example {puts [espdiff help compare]}]

    make_ensemble
}
