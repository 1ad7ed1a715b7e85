# endpoint_form.tcl: the form for one side of the comparison: a molecule of VMD or a file, with its frame and potential.

namespace eval ::espdiff::gui {
    variable form       ;# what the user entered: form(SIDE,FIELD)
    variable automatic  ;# per side: the potential chosen automatically, until the user changes it
    array set form {}
    array set automatic {source automatic target automatic}
    foreach side {source target} {
        array set form [list $side,kind file $side,mol "" $side,frame now $side,sel "not water" $side,file "" \
            $side,model 1 $side,map automatic $side,unit "as the map says"]
    }
    unset side

    variable units {"as the map says" kT/e mV V kcal/mol/e kJ/mol/e hartree/e}
    variable structure_types {{"Structures" {.pqr .pdb .ent .cif .mmcif .gro .mol2 .gz}} {"All files" *}}
    variable map_types {{"Potential maps" {.dx .vti .cube .cub .gz}} {"All files" *}}
    # In the place of a map: computed from the charges, and what the commands call it.
    variable computed {automatic "" "Poisson-Boltzmann" pb "PME, explicit water" pme "Coulomb, vacuum" coulomb}

    # Whether a form's potential is computed; also what is typed as {pb ionic_strength 0.05}.
    proc is_computed_map {text} {
        variable computed
        expr {[dict exists $computed $text] || [::espdiff::is_computed $text]}
    }

    # The commands' word for it; empty for the usual one.
    proc computed_map_word {text} {
        variable computed
        set word [expr {[dict exists $computed $text] ? [dict get $computed $text] : $text}]
        if {$word eq "pb"} { return [salt_water_map] }
        if {$word eq "" && [llength [salt_water_map]] > 1} {
            error "Settings, Salt water, are changed, which only Poisson-Boltzmann reads: choose it as Potential instead of\
                $text, or set them back"
        }
        return $word
    }

    proc build_endpoint {path side title} {
        variable form
        variable widget
        ttk::labelframe $path -text $title -padding {6 3}
        grid columnconfigure $path 1 -weight 1
        if {[in_vmd]} {
            set form($side,kind) mol
            ttk::frame $path.kind
            foreach {kind label} {mol "Molecule in VMD" file File} {
                ttk::radiobutton $path.kind.$kind -text $label -value $kind -variable ::espdiff::gui::form($side,kind) \
                    -command [list ::espdiff::gui::guard ::espdiff::gui::update_endpoint $side]
                pack $path.kind.$kind -side left -padx {0 10}
                set widget($side,kind,$kind) $path.kind.$kind
            }
            grid $path.kind -row 0 -column 0 -columnspan 3 -sticky w -pady {0 2}
        }
        build_molecule_rows $path $side
        build_file_rows $path $side
        build_map_rows $path $side
        build_prepare_row $path $side
        return $path
    }

    proc build_molecule_rows {path side} {
        variable widget
        ttk::combobox $path.mol -textvariable ::espdiff::gui::form($side,mol) -state readonly -width 12 \
            -postcommand [list ::espdiff::gui::guard ::espdiff::gui::update_endpoint $side]
        bind $path.mol <<ComboboxSelected>> [list ::espdiff::gui::guard ::espdiff::gui::choose_molecule $side]
        form_row $path 1 Molecule $path.mol "A molecule that is loaded in VMD"
        ttk::spinbox $path.frame -textvariable ::espdiff::gui::form($side,frame) -width 6 -from 0 -to 0 -increment 1
        form_row $path 2 Frame $path.frame "Frame of the trajectory: a number from 0, or now (the frame that VMD\
            shows), first or last"
        ttk::label $path.frames -foreground gray40
        grid $path.frames -row 2 -column 2 -sticky w -padx {4 0}
        ttk::entry $path.sel -textvariable ::espdiff::gui::form($side,sel) -width 12
        form_row $path 3 Atoms $path.sel "VMD selection of the atoms of the surface, such as: protein"
        grid configure $path.mol $path.sel -columnspan 2
        foreach name {mol frame frames sel} { set widget($side,$name) $path.$name }
    }

    proc build_file_rows {path side} {
        variable widget
        variable structure_types
        ttk::entry $path.file -textvariable ::espdiff::gui::form($side,file) -width 12
        form_row $path 4 File $path.file "Structure file: PQR (charges and radii), PDB, mmCIF or GRO, which get\
            charges by PDB2PQR"
        button $path.browse_file ... [list ::espdiff::gui::browse $side file $structure_types]
        tip $path.browse_file "Choose a file"
        grid $path.browse_file -row 4 -column 2 -padx {4 0} -sticky e
        ttk::spinbox $path.model -textvariable ::espdiff::gui::form($side,model) -width 6 -from 1 -to 9999 -increment 1
        form_row $path 5 Model $path.model "Model of a file with several models, from 1"
        foreach name {file browse_file model} { set widget($side,$name) $path.$name }
    }

    proc build_map_rows {path side} {
        variable widget
        variable map_types
        variable units
        ttk::combobox $path.map -textvariable ::espdiff::gui::form($side,map) -width 12 \
            -postcommand [list ::espdiff::gui::guard ::espdiff::gui::update_endpoint $side]
        form_row $path 6 Potential $path.map "Electrostatic potential: a data set of the molecule, a map file (DX, VTI,\
            cube), computed from the charges (in salt water by the values under Settings), or none to compare the shapes alone. Automatic: with explicit water in a\
            periodic cell PME, for other charges Poisson-Boltzmann."
        bind $path.map <<ComboboxSelected>> [list ::espdiff::gui::guard ::espdiff::gui::update_endpoint $side]
        bind $path.map <FocusOut> [list ::espdiff::gui::guard ::espdiff::gui::update_endpoint $side]
        button $path.browse_map ... [list ::espdiff::gui::browse $side map $map_types]
        tip $path.browse_map "Choose a map file"
        grid $path.browse_map -row 6 -column 2 -padx {4 0} -sticky e
        ttk::combobox $path.unit -textvariable ::espdiff::gui::form($side,unit) -values $units -state readonly -width 12
        form_row $path 7 Unit $path.unit "Unit of the map's values, if the map does not say; VMD's data sets do\
            not"
        # In the place of the unit: what the automatic choice is, and why. The row is never empty, so that nothing below
        # moves.
        tip [wrapping_label $path.choice -foreground gray40] ""
        grid $path.choice -row 7 -column 0 -columnspan 3 -sticky ew -pady 2
        grid rowconfigure $path 7 -minsize [expr {4 + max([winfo reqheight $path.unit],
            2 * [font metrics TkDefaultFont -linespace] + 4)}]
        foreach name {map browse_map unit choice} { set widget($side,$name) $path.$name }
    }

    # Shows the rows for the current choice, with VMD's current molecules, frames and data sets.
    proc update_endpoint {side} {
        variable form
        variable widget
        variable computed
        set is_molecule [expr {$form($side,kind) eq "mol"}]
        set parent [winfo parent $widget($side,map)]
        foreach name {mol frame frames sel label_mol label_frame label_sel} { show_if $is_molecule $parent.$name }
        foreach name {file browse_file model label_file label_model} { show_if [expr {!$is_molecule}] $parent.$name }
        if {$is_molecule} { update_molecule $side } else { $widget($side,map) configure -values [concat none [dict keys $computed]] }
        set map [string trim $form($side,map)]
        set has_map [expr {$map ni {none ""} && ![is_computed_map $map]}]
        foreach name {unit label_unit} { show_if $has_map $parent.$name }
        update_prepare_row $side
        show_if [expr {!$has_map}] $parent.choice
        foreach one {source target} { show_choice $one }
        foreach name {file map} { $widget($side,$name) xview [$widget($side,$name) index end] }
    }

    # What is automatic on one side depends on both.
    proc show_choice {side} {
        variable form
        variable widget
        if {![info exists widget($side,choice)] || ![winfo exists $widget($side,choice)]} return
        set choice [expr {[string trim $form($side,map)] eq "automatic" ? [automatic_choice $side] : ""}]
        $widget($side,choice) configure -text $choice
        set ::espdiff::gui::tips($widget($side,choice)) $choice
    }

    # What `automatic` takes for the molecules chosen now, as "Poisson-Boltzmann: charges without explicit water"; of shapes
    # alone the reason by this side's own molecule, if it has no charges.
    proc automatic_choice {side} {
        variable computed
        set endpoints {}
        foreach one [list $side [other_side $side]] {
            set endpoint [chosen_structure $one]
            if {$endpoint eq ""} { return "" }
            lappend endpoints $endpoint
        }
        if {[catch { ::espdiff::usual_potential_of $endpoints } choice]} { return "" }
        lassign $choice kind because
        if {$kind eq "none"} { return "Shapes alone: $because" }
        foreach {title word} $computed { if {$word eq $kind} { return "$title: $because" } }
        return "$kind: $because"
    }

    proc other_side {side} { expr {$side eq "source" ? "target" : "source"} }

    # {mol ID} or {file PATH}; empty while nothing is chosen.
    proc chosen_structure {side} {
        variable form
        if {$form($side,kind) eq "mol"} {
            set mol [number_of $form($side,mol)]
            return [expr {$mol eq "" || $mol ni [molinfo list] ? "" : [list mol $mol]}]
        }
        set path [string trim $form($side,file)]
        expr {[file isfile $path] ? [list file $path] : ""}
    }

    proc show_if {shown path} {
        if {$shown} { grid $path } else { grid remove $path }
    }

    # Molecules with atoms, as "0: ubq.psf".
    proc molecule_names {} {
        set names {}
        foreach mol [molinfo list] {
            if {[molinfo $mol get numatoms] > 0} { lappend names "$mol: [molinfo $mol get name]" }
        }
        return $names
    }

    # The number before the colon; empty if there is none.
    proc number_of {name} {
        if {[regexp {^(\d+): } $name -> number]} { return $number }
        return ""
    }

    proc update_molecule {side} {
        variable form
        variable widget
        set names [molecule_names]
        $widget($side,mol) configure -values $names
        # A molecule keeps its number when it is renamed; a deleted one gives its place to another one.
        set chosen [lsearch -inline $names "[number_of $form($side,mol)]: *"]
        if {$chosen ne $form($side,mol) || $chosen eq ""} {
            if {$chosen eq ""} { set chosen [default_molecule $side $names] }
            set form($side,mol) $chosen
            choose_molecule $side
        }
        set mol [number_of $form($side,mol)]
        if {$mol eq ""} {
            $widget($side,frames) configure -text ""
            $widget($side,map) configure -values none
            return
        }
        set last [expr {[molinfo $mol get numframes] - 1}]
        $widget($side,frame) configure -to [expr {max(0, $last)}]
        $widget($side,frames) configure -text [expr {$last < 0 ? "no frames" : $last == 0 ? "of 1" : "0 to $last"}]
        update_maps $side $mol
    }

    # The first molecule for the source, the second for the target.
    proc default_molecule {side names} { lindex $names [expr {$side eq "target" && [llength $names] > 1}] }

    # For another molecule: its own frame and potential.
    proc choose_molecule {side} {
        variable form
        variable automatic
        set form($side,frame) now
        if {[number_of $form($side,map)] ne ""} { set form($side,map) automatic }
        set automatic($side) $form($side,map)
        set mol [number_of $form($side,mol)]
        if {$mol ne ""} { update_maps $side $mol }
    }

    # Chooses a new molecule's first data set, unless the user has chosen otherwise.
    proc update_maps {side mol} {
        variable form
        variable automatic
        variable widget
        variable computed
        set names [data_set_names $mol]
        $widget($side,map) configure -values [concat none [dict keys $computed] $names]
        if {$form($side,map) eq $automatic($side)} {
            set form($side,map) [expr {[llength $names] > 0 ? [lindex $names 0] : "automatic"}]
            set automatic($side) $form($side,map)
        }
    }

    # "0: pot.dx": VMD does not name data sets, so the names of its files are used if their number matches.
    proc data_set_names {mol} {
        set files {}
        lassign [molinfo $mol get {filename filetype}] paths types
        foreach path $paths type $types {
            if {$type in {dx cube ccp4 map grd grid plt situs mrc edm vtk espdiffvti espdiffmap}} {
                lappend files [expr {$type eq "espdiffmap" ? "made by espdiff" : [file tail $path]}]
            }
        }
        set names {}
        set n [molinfo $mol get numvolumedata]
        for {set k 0} {$k < $n} {incr k} {
            lappend names "$k: [expr {[llength $files] == $n ? [lindex $files $k] : "data set"}]"
        }
        return $names
    }

    proc browse {side field types} {
        variable window
        variable form
        variable widget
        set folder [file dirname $form($side,file)]
        if {$form($side,file) eq "" || ![file isdirectory $folder]} { set folder [pwd] }
        set path [tk_getOpenFile -parent $window -filetypes $types -initialdir $folder]
        if {$path eq ""} return
        set form($side,$field) $path
        update_endpoint $side
    }

    # The form as an endpoint of `espdiff compare`. The frame is given by its number, so that a script of it is
    # repeatable.
    proc endpoint {side} {
        variable form
        variable computed
        set is_molecule [expr {$form($side,kind) eq "mol"}]
        set endpoint [expr {$is_molecule ? [molecule_endpoint $side] : [file_endpoint $side]}]
        set map [string trim $form($side,map)]
        if {$map in {none ""}} { return [concat $endpoint {map none}] }
        if {[is_computed_map $map]} {
            set word [computed_map_word $map]
            return [expr {$word eq "" ? $endpoint : [concat $endpoint [list map $word]]}]
        }
        if {$is_molecule} {
            set number [number_of $map]
            set map [expr {$number eq "" ? [list file $map] : $number}]
        }
        lappend endpoint map $map
        if {$form($side,unit) ne "as the map says"} { lappend endpoint unit $form($side,unit) }
        return $endpoint
    }

    proc molecule_endpoint {side} {
        variable form
        set mol [number_of $form($side,mol)]
        if {$mol eq ""} { error "$side: no molecule is chosen; load one into VMD, or choose a file" }
        set frame [string trim $form($side,frame)]
        if {$frame in {now ""} && $mol in [molinfo list]} { set frame [molinfo $mol get frame] }
        set endpoint [list mol $mol frame $frame]
        if {$form($side,sel) ne "not water"} { lappend endpoint sel $form($side,sel) }
        return $endpoint
    }

    proc file_endpoint {side} {
        variable form
        set path [string trim $form($side,file)]
        if {$path eq ""} { error "$side: no file is given; type its name or use the button beside it" }
        set endpoint [list file $path]
        if {[string trim $form($side,model)] ni {1 ""}} { lappend endpoint model [string trim $form($side,model)] }
        return $endpoint
    }

    # The mapping goes from source to target; the other direction is another comparison.
    proc swap_sides {} {
        variable form
        variable automatic
        foreach name [array names form source,*] {
            set other target[string range $name 6 end]
            lassign [list $form($name) $form($other)] form($other) form($name)
        }
        lassign [list $automatic(source) $automatic(target)] automatic(target) automatic(source)
        foreach side {source target} { update_endpoint $side }
    }
}
