/* SPDX-License-Identifier: GPL-2.0-or-later */
/* YADE makes itself a folder in /tmp when it is loaded, wherever TMPDIR points, dies with signal 11 where it can't, and
   leaves the folder behind. Nothing here uses it. Loaded before YADE, with its symbols for everyone, this stands in for
   Omega::initTemps() of libyade.so (core/Omega.cpp), which makes the folder. */

void _ZN4yade5Omega9initTempsEv(void* omega);

void _ZN4yade5Omega9initTempsEv(void* omega) { (void)omega; }
