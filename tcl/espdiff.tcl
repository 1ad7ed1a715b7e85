# espdiff.tcl: the package: loads the module, makes its file types known to VMD, and sources the parts.
package require Tcl 8.5-

namespace eval ::espdiff {
    variable directory [file dirname [file normalize [info script]]]

    # The package lies in PREFIX/tcl/espdiffVERSION, the module in PREFIX/molfile.
    proc module_path {} {
        variable directory
        if {[info exists ::env(ESPDIFF_MODULE)] && $::env(ESPDIFF_MODULE) ne ""} { return $::env(ESPDIFF_MODULE) }
        return [file normalize [file join $directory .. .. molfile espdiffplugin[info sharedlibextension]]]
    }

    proc in_vmd {} {
        expr {[info commands ::molinfo] ne "" && [info commands ::vmdinfo] ne "" && [info commands ::mol] ne ""}
    }

    proc load_module {} {
        set path [module_path]
        set remedy "install espdiff again (cmake --install BUILD --component vmd --prefix DIR),\
            or name the file in the environment variable ESPDIFF_MODULE"
        if {![file exists $path]} {
            return -code error -errorcode {ESPDIFF IO} "the module '$path' is missing; $remedy"
        }
        if {[catch {load $path Espdiff} message]} {
            return -code error -errorcode {ESPDIFF IO} "the module '$path' cannot be loaded ($message); $remedy"
        }
        if {![in_vmd] || [dict get [core::abi] in_vmd]} return
        # VMD has not opened it from its plugin folders. Without its file types maps go through DX files instead.
        if {[catch {plugin dlopen $path; plugin update} message]} {
            vmdcon -warn "espdiff) VMD did not take the file types of '$path' ($message); maps go through DX files"
        }
    }
}

::espdiff::load_module
foreach ::espdiff::part {
    files options metrics commands manual jobs endpoint vmd/vmd_molecule vmd/vmd_view vmd/vmd_volume compute potential
    ensemble vmd/ensemble_frames vmd/draw report vmd/figure vmd/drawing_watch script_words vmd/saved_state vmd/linked_view vmd/highlight vmd/letters vmd/legend vmd/picked matrix vmd/atoms vmd/atom_colors plot plot_file vmd/averaged_map vmd/frame_maps trajectory trajectory_steps vmd/view
    doctor
} {
    source [file join $::espdiff::directory $::espdiff::part.tcl]
}
unset ::espdiff::part

# The entry of VMD's menu calls this, by `vmd_install_extension espdiff espdiff_tk "Analysis/..."` in .vmdrc; VMD wants
# the path of the window, whose close button it then takes over.
proc espdiff_tk {} {
    set window [espdiff gui]
    after idle {::espdiff::gui::guard ::espdiff::gui::take_close_button}
    return $window
}

package provide espdiff [::espdiff::core::version]
