<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="fr">
<context>
    <name>App::Property</name>
    <message>
        <location filename="../../freecad_am/objects/cladding_feature.py"/>
        <source>A further part that the nozzle is kept clear of.</source>
        <translation>Une pièce supplémentaire que la buse évite.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>A machine of the list, or the path of a machine file.</source>
        <translation>Une machine de la liste, ou le chemin d&apos;un fichier machine.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>A region narrower than a bead gets a single bead, or the job is refused.</source>
        <translation>Une région plus étroite qu&apos;un cordon reçoit un seul cordon, ou le travail est refusé.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/feature.py"/>
        <source>A straight edge, sketch axis or datum line to turn about, where the shape has none. A sketch is turned about its vertical axis unless another one is chosen.</source>
        <translation>Une arête droite, un axe d&apos;esquisse ou une ligne de référence autour de laquelle tourner, si la forme n&apos;en a pas. Une esquisse tourne autour de son axe vertical, sauf si un autre est choisi.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>Against gravity, as x y z in the world.</source>
        <translation>À l&apos;opposé de la pesanteur, sous la forme x y z dans le monde.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>Allowed rotation about the tool axis; a full turn means free, narrower for a torch that is not coaxial.</source>
        <translation>Rotation permise autour de l&apos;axe de l&apos;outil ; un tour entier veut dire libre, moins pour une torche qui n&apos;est pas coaxiale.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/toolpath.py"/>
        <source>An inspection of the substrate by a scan of it, which the first layers are fitted to.</source>
        <translation>Un contrôle du substrat par sa numérisation, sur laquelle les premières couches sont ajustées.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>Analogue output for the speed of the wire where it follows the travel speed.</source>
        <translation>Sortie analogique qui dit la vitesse du fil là où elle suit la vitesse d&apos;avance.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>Angle between the nozzle&apos;s axis and its side.</source>
        <translation>Angle entre l&apos;axe de la buse et son flanc.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/cladding_feature.py"/>
        <source>Area of the faces.</source>
        <translation>Aire des faces.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/stage.py"/>
        <source>Arrays of the result.</source>
        <translation>Tableaux du résultat.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Beads that close gaps are made no shorter than this; others that are shorter are left out. auto: 2 mm, or the bead spacing where that is less. (mm)</source>
        <translation>Les cordons qui comblent des jours ne sont pas plus courts que cela ; les autres plus courts sont laissés de côté. auto : 2 mm, ou l&apos;espacement des cordons s&apos;il est plus petit. (mm)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>By how much the input&apos;s value in a program rises with a degree.</source>
        <translation>De combien la valeur de l&apos;entrée dans un programme monte par degré.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>Change of the objective and of the coefficients at which the optimiser stops.</source>
        <translation>Variation de l&apos;objectif et des coefficients à laquelle l&apos;optimiseur s&apos;arrête.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/feature.py"/>
        <source>Clamps and other bodies around the part, which the nozzle is kept clear of.</source>
        <translation>Brides et autres corps autour de la pièce, dont la buse est tenue éloignée.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>Closed beads layer by layer, or one continuous spiral.</source>
        <translation>Cordons fermés couche par couche, ou une spirale continue.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>Compare the joint path with a lower bound over all rotations about the tool axis. Takes up to seconds per bead.</source>
        <translation>Compare la trajectoire articulaire à une borne inférieure sur toutes les rotations autour de l’axe de l’outil. Prend jusqu’à quelques secondes par cordon.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Contours are laid round lines and the like.</source>
        <translation>Des contours sont déposés autour des lignes et autres motifs.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>Degree of the polynomial of a layer.</source>
        <translation>Degré du polynôme d&apos;une couche.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Density of the deposit in g/cm³, for its mass.</source>
        <translation>Masse volumique du dépôt en g/cm³ ; donne sa masse.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Deposit switched off this long after a bead ends.</source>
        <translation>Dépôt coupé ce temps après la fin d&apos;un cordon.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Deposit switched off this long after a bead ends. (s)</source>
        <translation>Dépôt coupé ce temps après la fin d&apos;un cordon. (s)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Deposit switched on this long before a bead starts.</source>
        <translation>Dépôt mis en marche ce temps avant le début d&apos;un cordon.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Deposit switched on this long before a bead starts. (s)</source>
        <translation>Dépôt mis en marche ce temps avant le début d&apos;un cordon. (s)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/inspection.py"/>
        <source>Deviations up to this, outside or inside, are within tolerance.</source>
        <translation>Les écarts jusqu&apos;à cette valeur, vers l&apos;extérieur ou l&apos;intérieur, sont dans la tolérance.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>Diameter of the nozzle&apos;s flat tip.</source>
        <translation>Diamètre du bout plat de la buse.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>Diameter of the platform; counts in clearance.</source>
        <translation>Diamètre du plateau ; compte dans le dégagement.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Diameter of the wire.</source>
        <translation>Diamètre du fil.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>Digital output that switches the deposit.</source>
        <translation>Sortie logique qui commande le dépôt.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Direction of closed beads seen against the build direction; open beads run as found unless alternate.</source>
        <translation>Sens des cordons fermés vu contre la direction de dépôt ; les cordons ouverts courent tels que trouvés, sauf avec alternate.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Direction of lines and zigzags; 0 runs around the hub, 90 deg along it.</source>
        <translation>Direction des lignes et des zigzags ; 0 court autour du moyeu, 90 deg le long de celui-ci.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>Direction x y z from the deposit towards the tool, in the part&apos;s coordinates, where neither the curves nor faces say one.</source>
        <translation>Direction x y z du dépôt vers l&apos;outil, dans les coordonnées de la pièce, là où ni les courbes ni des faces n&apos;en indiquent.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Distance between neighbouring beads of a layer.</source>
        <translation>Distance entre cordons voisins d&apos;une couche.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>Distance between neighbouring layers.</source>
        <translation>Distance entre couches voisines.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>Divides the translation rows of the Jacobian.</source>
        <translation>Divise les lignes de translation du jacobien.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/path_view.py"/>
        <source>Draw beads as lines, or as tubes as wide and high as they are.</source>
        <translation>Dessiner les cordons en lignes, ou en tubes aussi larges et hauts qu&apos;eux.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/surface_feature.py"/>
        <source>Edges of the wall in which layers start, in place of where it leaves the substrate.</source>
        <translation>Arêtes de la paroi où commencent les couches, au lieu de là où elle quitte le substrat.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>External axes. level: they turn no more than the angle from the vertical asks for; optimised: one polynomial per bead of each, together with the rotation about the tool, for less motion and larger margins.</source>
        <translation>Axes externes. level : ils ne tournent pas plus que l&apos;angle à la verticale ne le demande ; optimised : un polynôme par cordon pour chacun, avec la rotation autour de l&apos;outil, pour moins de mouvement et de plus grandes marges.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/feature.py"/>
        <source>Faces of the wall, from the platform up.</source>
        <translation>Faces de la paroi, du plateau vers le haut.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/surface_feature.py"/>
        <source>Faces of the wall.</source>
        <translation>Faces de la paroi.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/cladding_feature.py"/>
        <source>Faces that are covered.</source>
        <translation>Faces qui sont recouvertes.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Fastest travel speed at which the material is laid; faster beads are reported. (mm/s)</source>
        <translation>Vitesse d&apos;avance la plus rapide à laquelle le matériau est déposé ; les cordons plus rapides sont signalés. (mm/s)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>Feed of joint moves: the time of each (G93), or the speed of the linear axes wherever they move (G94).</source>
        <translation>Avance des mouvements articulaires : le temps de chacun (G93), ou la vitesse des axes linéaires partout où ils bougent (G94).</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>Fewest points of a full turn, however small its radius.</source>
        <translation>Nombre minimal de points d&apos;un tour entier, si petit que soit son rayon.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/stage.py"/>
        <source>Findings, as JSON.</source>
        <translation>Remarques, en JSON.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/stage.py"/>
        <source>Fingerprint of the inputs the result was made from.</source>
        <translation>Empreinte des entrées dont le résultat a été fait.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>First bead of that layer.</source>
        <translation>Premier cordon de cette couche.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>First layer to deposit.</source>
        <translation>Première couche à déposer.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>Four axes only: by how much the tool may miss the direction asked for.</source>
        <translation>Quatre axes seulement : de combien l&apos;outil peut manquer la direction demandée.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>From the base circle to the apex of the cone, along the axis; inf: a cylinder. (mm)</source>
        <translation>Du cercle de base au sommet du cône, le long de l&apos;axe ; inf : un cylindre. (mm)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>From the flange, or the face of a rotary table, to the mounting plane along its Z, or a pose on it. (mm)</source>
        <translation>De la bride, ou de la face d&apos;un axe rotatif, au plan de montage le long de son Z, ou une pose sur elle. (mm)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/toolpath.py"/>
        <source>Further features, deposited after it in this order.</source>
        <translation>Autres éléments, déposés après lui dans cet ordre.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>Further methods planned for the comparison of the report.</source>
        <translation>Autres méthodes planifiées pour la comparaison du rapport.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/developable_feature.py"/>
        <source>Further solids or closed meshes to deposit on the same hub.</source>
        <translation>Autres solides ou maillages fermés à déposer sur le même moyeu.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/solid_feature.py"/>
        <source>Further solids or closed meshes to deposit.</source>
        <translation>Autres solides ou maillages fermés à déposer.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>Further spacings whose joint paths are planned for the comparison of the report.</source>
        <translation>Autres espacements dont les trajectoires articulaires sont planifiées pour la comparaison du rapport.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>Group output, H word, register or analogue output that carries it; for KUKA the first of eight outputs.</source>
        <translation>Sortie de groupe, mot H, registre ou sortie analogique qui le transmet ; chez KUKA la première de huit sorties.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/solid_feature.py"/>
        <source>Height along the stacking direction.</source>
        <translation>Hauteur suivant la direction d&apos;empilement.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/inspection.py"/>
        <source>Heights above the part&apos;s base, in mm, at which circularity is evaluated; none: a sixth, a half and five sixths of what was measured.</source>
        <translation>Hauteurs au-dessus de la base de la pièce, en mm, auxquelles la circularité est dite ; aucune : un sixième, la moitié et cinq sixièmes de ce qui a été mesuré.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>Holes of meshes up to this size across are closed, with a note; larger ones are refused.</source>
        <translation>Les trous des maillages jusqu&apos;à cette largeur sont fermés, ce qui est signalé ; les plus grands sont refusés.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>How far a closed bead runs on past its seam.</source>
        <translation>De combien un cordon fermé continue au-delà de sa couture.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>How far a touched point may be from where the others say that it is.</source>
        <translation>De combien un point palpé peut s&apos;écarter d&apos;où les autres le situent.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>How far the deposit is to reach beyond the part everywhere, to be machined off: its shape is predicted and compared with the part; none: it is not. (mm)</source>
        <translation>De combien le dépôt doit dépasser la pièce partout, pour être usiné : sa forme est prédite et comparée à la pièce ; rien : elle ne l&apos;est pas. (mm)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>How far the deposit stands out from the part, to be machined off; above it by the layers that begin less than that above its last one.</source>
        <translation>De combien le dépôt dépasse sur les côtés de la pièce, à usiner ; au-dessus, des couches qui commencent moins haut que cela au-dessus de sa dernière.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>How far the direction of lines and zigzags turns from layer to layer.</source>
        <translation>De combien la direction des lignes et des zigzags tourne d&apos;une couche à l&apos;autre.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/scan.py"/>
        <source>How far the height of layers may differ from the layer height where they lead from what was scanned back to the plan. (%)</source>
        <translation>Écart permis entre la hauteur des couches et la hauteur de couche là où elles ramènent de ce qui a été numérisé au plan. (%)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/scan.py"/>
        <source>How far the scan may lie from what was planned; farther, and it is taken for a scan of something else.</source>
        <translation>Distance permise entre la numérisation et ce qui était prévu ; au-delà, elle passe pour la numérisation d&apos;autre chose.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>How far the start moves from layer to layer.</source>
        <translation>De combien le départ se déplace d&apos;une couche à l&apos;autre.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>How far the tool is withdrawn along its axis between beads.</source>
        <translation>De combien l&apos;outil est retiré le long de son axe entre les cordons.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>How far the torch goes back over an open bead from its end, still depositing, so that its crater is filled.</source>
        <translation>Distance sur laquelle la torche revient sur un cordon ouvert depuis sa fin, en déposant toujours, afin de remplir son cratère.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>How layers are found: on a tube of one surface by its closed parameter and on all other walls as fronts (auto), or as fronts on every wall (fronts).</source>
        <translation>Comment les couches sont trouvées : sur un tube d&apos;une seule surface par son paramètre fermé, sur toute autre paroi par des fronts (auto), ou par des fronts sur toutes les parois (fronts).</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/stage.py"/>
        <source>How long computing took.</source>
        <translation>Combien de temps a pris le calcul.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/macro/parts.py"/>
        <source>How long one unit of the file is.</source>
        <translation>Longueur d&apos;une unité du fichier.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>How long to wait between layers.</source>
        <translation>Temps d&apos;attente entre les couches.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>How long to wait between layers. (s)</source>
        <translation>Temps d&apos;attente entre les couches. (s)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>How many contours lie round lines and the like; inf: contours only.</source>
        <translation>Nombre de contours autour des lignes et autres motifs ; inf : contours seuls.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>How many layers lie on the faces, one layer height over the other along their normals.</source>
        <translation>Nombre de couches sur les faces, l&apos;une à une hauteur de couche au-dessus de l&apos;autre, le long de leurs normales.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>How many times the curves are laid, one layer height over the other.</source>
        <translation>Combien de fois les courbes sont déposées, l&apos;une à une hauteur de couche au-dessus de l&apos;autre.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>How much corners within a bead are rounded, percent: CNT of FANUC, and of the most that others may.</source>
        <translation>Arrondi des coins dans un cordon, en pour cent : CNT de FANUC, et du plus grand permis pour les autres.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>How much of the bead it is.</source>
        <translation>Quelle longueur du cordon c&apos;est.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>How narrow and how wide beads may be, of their usual width and spacing, so that contours come out even over the thickness of a region, and beads in thin places are as wide as these. (%)</source>
        <translation>Largeurs extrêmes que les cordons peuvent avoir, en part de leur largeur et de leur écartement habituels, pour que les contours se répartissent également sur l&apos;épaisseur d&apos;une région et que les cordons aient la largeur des endroits minces. (%)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>How narrow, of their usual width, beads in planes may be laid where others leave them less room; all of it: none is, and layers get higher there. (%)</source>
        <translation>À quelle part de leur largeur habituelle les cordons en couches planes peuvent se réduire là où d&apos;autres leur laissent moins de place ; toute la largeur : aucun ne se réduit, et les couches y deviennent plus hautes. (%)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/inspection.py"/>
        <source>How the points may be moved onto the part: best fit, shifts only, a turn about and a shift along the part&apos;s axis, or none but what pairs of points say.</source>
        <translation>Comment les points peuvent être ramenés sur la pièce : meilleur ajustement, translations seules, rotation autour de l&apos;axe de la pièce et translation le long de celui-ci, ou rien que ce que disent les paires de points.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>How wide the beads of solids on hubs count in filling: as the spacing, or as the bead width; auto: as the bead width where it is given, held by a bead model, or an overlap counts with it.</source>
        <translation>Largeur pour laquelle comptent au remplissage les cordons de solides sur moyeu : la distance des cordons, ou la largeur de cordon ; auto : la largeur de cordon si elle est donnée, tenue par un modèle de cordon, ou si un recouvrement compte avec elle.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>Iterations after which the optimiser gives up on a layer.</source>
        <translation>Nombre d&apos;itérations après lequel l&apos;optimiseur renonce à une couche.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Largest angle between the stacking direction and a wall that leans out, before there is a warning; 90 deg: none.</source>
        <translation>Plus grand angle entre la direction d&apos;empilement et une paroi en surplomb, avant un avertissement ; 90 deg : aucun.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/build_direction.py"/>
        <source>Largest angle between the tool axis and the vertical of the part.</source>
        <translation>Plus grand angle entre l&apos;axe de l&apos;outil et la verticale de la pièce.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Largest change of the travel speed along a bead, in mm/s per second, where a bead model sets it.</source>
        <translation>Plus grande variation de la vitesse d&apos;avance le long d&apos;un cordon, en mm/s par seconde, là où un modèle de cordon la règle.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/inspection.py"/>
        <source>Largest deviation.</source>
        <translation>Plus grand écart.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>Largest distance between a bead and the straight segments that stand for it.</source>
        <translation>Plus grande distance entre un cordon et les segments droits qui le représentent.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>Largest error of the local distance of constant-distance layers.</source>
        <translation>Plus grande erreur de la distance locale des couches constant-distance.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Largest share by which beads may lie nearer together or farther apart than the bead spacing on faces that are bent both ways; these are covered in pieces that keep to it. (%)</source>
        <translation>Plus grande part dont les cordons peuvent être plus serrés ou plus espacés que l&apos;espacement des cordons sur des faces courbées dans les deux sens ; elles sont couvertes par morceaux qui s&apos;y tiennent. (%)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/build_direction.py"/>
        <source>Largest turn of build direction and tool axis along a bead, on walls on an existing part, on hubs and in curved layers; where they would turn faster, at corners, they are spread out, and the deviation is reported. (deg/mm)</source>
        <translation>Plus grande rotation de la direction de dépôt et de l&apos;axe de l&apos;outil le long d&apos;un cordon, sur les parois d&apos;une pièce existante, sur les moyeux et dans les couches courbes ; là où ils tourneraient plus vite, aux angles, ils sont étalés, et leur écart est dit. (deg/mm)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>Last layers trimmed flush with the wall&apos;s upper edge, or whole layers only.</source>
        <translation>Dernières couches coupées au ras du bord supérieur de la paroi, ou couches entières seulement.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>Layers at the layer height from the nearest point of the one below (constant-distance), within a band of it and without corners (smooth), or along the lines up the wall (iso-parameter).</source>
        <translation>Couches à la hauteur de couche du point le plus proche de celle du dessous (constant-distance), dans une bande autour d&apos;elle et sans angles (smooth), ou le long des lignes qui montent la paroi (iso-parameter).</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>Layers equally spaced along the wall (arc-length) or along the axis (iso-height).</source>
        <translation>Couches également espacées le long de la paroi (arc-length) ou le long de l&apos;axe (iso-height).</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/joint_path.py"/>
        <source>Lead times and waits between layers (s).</source>
        <translation>Temps d&apos;avance et de retard et attentes entre les couches (s).</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/inspection.py"/>
        <source>Least deviation.</source>
        <translation>Plus petit écart.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Least time between the end of a solid&apos;s layer and the start of its next.</source>
        <translation>Temps minimal entre la fin de la couche d&apos;un solide et le début de la suivante.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Least time between the end of a solid&apos;s layer and the start of its next. (s)</source>
        <translation>Temps minimal entre la fin de la couche d&apos;un solide et le début de la suivante. (s)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Least time of a layer, from its first bead to the next layer&apos;s; the machine waits for what is missing, and islands come in the same order in every layer, so that each cools while the others are laid.</source>
        <translation>Durée minimale d&apos;une couche, de son premier cordon à celui de la suivante ; la machine attend ce qui manque, et les îlots viennent dans le même ordre à chaque couche, afin que chacun refroidisse pendant le dépôt des autres.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Least time of a layer, from its first bead to the next layer&apos;s; the machine waits for what is missing, and islands come in the same order in every layer, so that each cools while the others are laid. (s)</source>
        <translation>Durée minimale d&apos;une couche, de son premier cordon à celui de la suivante ; la machine attend ce qui manque, et les îlots viennent dans le même ordre à chaque couche, afin que chacun refroidisse pendant le dépôt des autres. (s)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>Least time of a layer, from its first bead to the next layer&apos;s; the machine waits for what is missing.</source>
        <translation>Durée minimale d&apos;une couche, de son premier cordon à celui de la suivante ; la machine attend ce qui manque.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>Least time of a layer, from its first bead to the next layer&apos;s; the machine waits for what is missing. (s)</source>
        <translation>Durée minimale d&apos;une couche, de son premier cordon à celui de la suivante ; la machine attend ce qui manque. (s)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Length beside it along which the speed changes step by step to that of the bead.</source>
        <translation>Longueur à côté, le long de laquelle la vitesse passe par paliers à celle du cordon.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/toolpath.py"/>
        <source>Length of all beads.</source>
        <translation>Longueur de tous les cordons.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/joint_path.py"/>
        <source>Length of the deposit as it is run.</source>
        <translation>Longueur du dépôt tel que parcouru.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/path_view.py"/>
        <source>Length of the lines that show build directions.</source>
        <translation>Longueur des lignes qui montrent les directions de dépôt.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/feature.py"/>
        <source>Length of the meridian.</source>
        <translation>Longueur du méridien.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>Length of the nozzle from its tip.</source>
        <translation>Longueur de la buse à partir de son bout.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>LinuxCNC: M428 and M429 choose between tip and axes; false for a machine with axes only.</source>
        <translation>LinuxCNC : M428 et M429 choisissent entre bout d&apos;outil et axes ; faux pour une machine qui n&apos;a que ses axes.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>LinuxCNC: how far corners may be rounded (G64 P).</source>
        <translation>LinuxCNC : de combien les angles peuvent être arrondis (G64 P).</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Longest way from one line of a zigzag to the next, as a share of the bead spacing; where it would be longer another zigzag begins. (%)</source>
        <translation>Plus long chemin d&apos;une ligne d&apos;un zigzag à la suivante, en part de la distance des cordons ; là où il serait plus long un autre zigzag commence. (%)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>M or H word that switches the deposit off.</source>
        <translation>Mot M ou H qui coupe le dépôt.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>M or H word that switches the deposit on, such as M7 or H2=1; without one the digital output does.</source>
        <translation>Mot M ou H qui met le dépôt en marche, comme M7 ou H2=1 ; sans lui la sortie logique le fait.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/cell.py"/>
        <source>Maker and model of the machine.</source>
        <translation>Constructeur et modèle de la machine.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/joint_path.py"/>
        <source>Mass of the deposit (g).</source>
        <translation>Masse du dépôt (g).</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/inspection.py"/>
        <source>Mean deviation, outside with a plus.</source>
        <translation>Écart moyen, vers l&apos;extérieur avec un plus.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>Method constant: the one RZ, or auto to search it. (deg)</source>
        <translation>Méthode constant : le RZ unique, ou auto pour le chercher. (deg)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>Method layer-by-layer: polynomials that are given, not searched: layer/bead:constant:slope, or * for every other bead, in deg and deg per turn.</source>
        <translation>Méthode layer-by-layer : polynômes donnés, non cherchés : couche/cordon:constante:pente, ou * pour tout autre cordon, en deg et deg par tour.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Middle x y z of the base circle and direction i j k of the axis, towards the apex, in the part&apos;s coordinates.</source>
        <translation>Centre x y z du cercle de base et direction i j k de l&apos;axe, vers le sommet, dans les coordonnées de la pièce.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>Most points of one program file; longer ones are chained.</source>
        <translation>Nombre maximal de points d&apos;un fichier de programme ; les plus longs sont enchaînés.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Name of the material; carried to the report.</source>
        <translation>Nom du matériau ; repris dans le rapport.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/program.py"/>
        <source>Name of the program and of its files.</source>
        <translation>Nom du programme et de ses fichiers.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Name of the program to call between layers, such as nozzle cleaning.</source>
        <translation>Nom du programme à appeler entre les couches, comme le nettoyage de la buse.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>Name of the programs that are called, without their number: SCHEDULE3.</source>
        <translation>Nom des programmes appelés, sans leur numéro : SCHEDULE3.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>Name or number of the positioner on the controller: mechanical unit of ABB (without one STN1), MACHINE_DEF of KUKA (2), motion group of FANUC (2).</source>
        <translation>Nom ou numéro du positionneur sur la commande : unité mécanique d&apos;ABB (sans indication STN1), MACHINE_DEF de KUKA (2), groupe de mouvement de FANUC (2).</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/build_direction.py"/>
        <source>Normal of the plane of symmetry-plane, as x y z in the part&apos;s coordinates; auto: the plane of a bend.</source>
        <translation>Normale du plan de symmetry-plane, en x y z dans les coordonnées de la pièce ; auto : le plan d&apos;un coude.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/toolpath.py"/>
        <source>Number of beads.</source>
        <translation>Nombre de cordons.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/curves_feature.py"/>
        <source>Number of curves.</source>
        <translation>Nombre de courbes.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/toolpath.py"/>
        <source>Number of layers.</source>
        <translation>Nombre de couches.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/toolpath.py"/>
        <source>Number of points of all beads.</source>
        <translation>Nombre de points de tous les cordons.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/inspection.py"/>
        <source>Number of points that count.</source>
        <translation>Nombre de points qui comptent.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/developable_feature.py"/>
        <source>Number of solids.</source>
        <translation>Nombre de solides.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Number of the analogue input that the sensor is on.</source>
        <translation>Numéro de l&apos;entrée analogique du capteur.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Number of the controller&apos;s own weave that beads are laid with; 0 or none: straight.</source>
        <translation>Numéro du balayage propre à la commande avec lequel les cordons sont déposés ; 0 ou aucun : droits.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Number of the digital input to wait for between layers.</source>
        <translation>Numéro de l&apos;entrée logique à attendre entre les couches.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Number of the schedule by which the welder or extruder lays beads; program.schedule says how it is sent.</source>
        <translation>Numéro qui dit au poste de soudage ou à l&apos;extrudeuse comment déposer les cordons ; program.schedule dit comment il est transmis.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>Number of the tool frame named in the program.</source>
        <translation>Numéro du repère outil nommé dans le programme.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>Number of the user frame named in the program.</source>
        <translation>Numéro du repère utilisateur nommé dans le programme.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>One polynomial per layer, one value per point, or one value for the whole job.</source>
        <translation>Un polynôme par couche, une valeur par point, ou une valeur pour tout le travail.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Overlap of neighbouring beads as a share of the bead width; takes the place of the bead spacing. (%)</source>
        <translation>Recouvrement de cordons voisins en part de la largeur de cordon ; tient lieu de la distance des cordons. (%)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Parallel contours, parallel lines, or either linked: connected, spiral, zigzag; below 100 % also grid, triangles, honeycomb, gyroid.</source>
        <translation>Contours parallèles, lignes parallèles, ou l&apos;un ou l&apos;autre reliés : contours reliés, spirale, zigzag ; au-dessous de 100 % aussi grille, triangles, nid d&apos;abeilles, gyroïde.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/inspection.py"/>
        <source>Planned thickness of the wall, half of it on each side of the planned surface; 0: the planned surface itself is the measured one.</source>
        <translation>Épaisseur prévue de la paroi, une moitié de chaque côté de la surface prévue ; 0 : la surface prévue elle-même est celle mesurée.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>Points as joint values, or as positions of the tool.</source>
        <translation>Points en valeurs articulaires, ou en positions de l&apos;outil.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/inspection.py"/>
        <source>Points up to this far above or below such a height count there, slid along the planned surface.</source>
        <translation>Les points jusqu&apos;à cette distance au-dessus ou au-dessous d&apos;une telle hauteur y comptent, glissés le long de la surface prévue.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Radius of the base circle; auto: the face chosen, or the one that the solids stand on. (mm)</source>
        <translation>Rayon du cercle de base ; auto : la face choisie, ou celle sur laquelle reposent les solides. (mm)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/inspection.py"/>
        <source>Radius of the probe&apos;s ball where its centre was measured; 0 where the points lie on the surface.</source>
        <translation>Rayon de la bille du palpeur si son centre a été mesuré ; 0 si les points sont sur la surface.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/build_direction.py"/>
        <source>Robots with a positioner: largest angle between the tool axis and the vertical of the cell while depositing; the positioner turns the part so far. 180 deg: it stands still.</source>
        <translation>Robots avec positionneur : plus grand angle entre l&apos;axe de l&apos;outil et la verticale de la cellule pendant le dépôt ; le positionneur tourne la pièce en conséquence. 180 deg : il reste immobile.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>Robots: external axes that carry the part or the robot, such as: motoman-motopos-d500 at 1500 0 0 0 0 0 carries part. x y z mm, RX RY RZ deg of the base in the world, which is the robot&apos;s base frame; more than one with ; between.</source>
        <translation>Robots : axes à côté d&apos;eux qui portent la pièce ou le robot, par exemple : motoman-motopos-d500 at 1500 0 0 0 0 0 carries part. x y z en mm, RX RY RZ en deg de la base dans le monde, qui est le repère de base du robot ; plusieurs séparés par ;.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>Robots: file of the torch as closed solids, mm, its tip at the origin, Z out of the nozzle; what lies beyond the length of the nozzle keeps the arm&apos;s clearance as links do.</source>
        <translation>Robots : fichier de la torche en solides fermés, en mm, sa pointe à l&apos;origine, Z sortant de la buse ; ce qui dépasse la longueur de la buse garde la distance du bras comme les segments.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>Robots: how far the links stay from part, deposit, platform, fixtures and nozzle, rapids included; left out, planning does not look at them. (mm)</source>
        <translation>Robots : distance que les corps du bras gardent à la pièce, au dépôt, à la plateforme, aux montages et à la buse, déplacements rapides compris ; sans valeur, la planification ne les regarde pas. (mm)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>Robots: shoulder, elbow and wrist, or auto to search all eight.</source>
        <translation>Robots : épaule, coude et poignet, ou auto pour chercher parmi les huit.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>Robots: what stands in the cell, which nozzle, part and links are kept clear of, such as: table = table.step at 0 0 -200 0 0 0; post = box 60 60 400 at 900 200 0 0 0 0. x y z mm, RX RY RZ deg of the file&apos;s origin, or of the middle of the box, in the maker&apos;s base frame.</source>
        <translation>Robots : ce qui se trouve dans la cellule et que la buse, la pièce et les segments évitent, par exemple : table = table.step at 0 0 -200 0 0 0 ; post = box 60 60 400 at 900 200 0 0 0 0. x y z mm, RX RY RZ deg de l&apos;origine du fichier, ou du milieu de la boîte, dans le repère de base du constructeur.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>Robots: where the deposit comes out, its Z pointing to the tool; with the tool on the robot, the fixed platform. In the maker&apos;s base frame.</source>
        <translation>Robots : là où sort le dépôt, son Z pointant vers l&apos;outil ; avec l&apos;outil sur le robot, le plateau fixe. Dans le repère de base du constructeur.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>Rotary table only: which of the two turning axes, counted from the torch, stands still (four axes).</source>
        <translation>Plateau rotatif seulement : lequel des deux axes de rotation, comptés à partir de la torche, reste immobile (quatre axes).</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>SINUMERIK: block compressor (COMPCAD) in beads whose feed is a speed.</source>
        <translation>SINUMERIK : compresseur de blocs (COMPCAD) dans les cordons dont l&apos;avance est une vitesse.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>SINUMERIK: rounding (G642), jerk limit (SOFT) and feed forward (FFWON).</source>
        <translation>SINUMERIK : arrondi (G642), limitation du jerk (SOFT) et anticipation (FFWON).</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Schedule that is sent there, without a stop.</source>
        <translation>Programme de soudage qui y est transmis, sans arrêt.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Sets the travel speed so that beads keep their width in bends: none, csw (steel, Dai 2020), li-2025 (aluminium), or the path of a calibration table.</source>
        <translation>Règle la vitesse d&apos;avance pour que les cordons gardent leur largeur dans les courbes : none, csw (acier, Dai 2020), li-2025 (aluminium), ou le chemin d&apos;une table d&apos;étalonnage.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/toolpath.py"/>
        <source>Several features: one after the other, or the lowest layer of all first.</source>
        <translation>Plusieurs éléments : l&apos;un après l&apos;autre, ou la couche la plus basse de tous d&apos;abord.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/toolpath.py"/>
        <source>Several features: what of the process differs for each, as JSON.</source>
        <translation>Plusieurs éléments : ce qui diffère du procédé pour chacun, en JSON.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Share of the area inside of the walls that beads fill: their length times their spacing. (%)</source>
        <translation>Part de la surface à l&apos;intérieur des contours que les cordons remplissent : leur longueur multipliée par leur écartement. (%)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Share of the layer height by which layers along a guide may be higher or lower beside it. (%)</source>
        <translation>Part de la hauteur de couche dont les couches le long d&apos;un guide peuvent être plus hautes ou plus basses à côté de lui. (%)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>Share of the layer height by which the local distance of smooth layers may differ; of iso-parameter layers, before there is a warning. (%)</source>
        <translation>Part de la hauteur de couche dont la distance locale des couches smooth peut différer ; pour les couches iso-parameter, avant un avertissement. (%)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/inspection.py"/>
        <source>Share of the points within tolerance (%).</source>
        <translation>Part des points dans la tolérance (%).</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/inspection.py"/>
        <source>Share of the points, those farthest off, that the fit leaves out. (%)</source>
        <translation>Part des points, les plus écartés, que l&apos;ajustement laisse de côté. (%)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Shielding gas; carried along.</source>
        <translation>Gaz de protection ; transmis tel quel.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>Shoulder, elbow and wrist of this joint path; cell: as the cell says.</source>
        <translation>Épaule, coude et poignet de cette trajectoire articulaire ; cell : ce que dit la cellule.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/inspection/view.py"/>
        <source>Show in the corner of the view what the colours mean.</source>
        <translation>Montrer dans le coin de la vue ce que veulent dire les couleurs.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/path_view.py"/>
        <source>Show the build direction of every how many-th point.</source>
        <translation>Montrer la direction de dépôt d&apos;un point sur combien.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/path_view.py"/>
        <source>Show the build directions as short lines.</source>
        <translation>Montrer les directions de dépôt par de courtes lignes.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/views/cell.py"/>
        <source>Show the machine at rest, the nozzle upright on the highest point.</source>
        <translation>Montrer la machine au repos, la buse droite sur le point le plus haut.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/views/joint_path.py"/>
        <source>Show the rapid moves as thin dashed lines.</source>
        <translation>Montrer les mouvements rapides par de fins tirets.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/inspection/view.py"/>
        <source>Size of the points in pixels.</source>
        <translation>Taille des points en pixels.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Slowest travel speed at which the material is laid; slower beads are reported. (mm/s)</source>
        <translation>Vitesse d&apos;avance la plus lente à laquelle le matériau est déposé ; les cordons plus lents sont signalés. (mm/s)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>Smallest condition allowed; auto: at each point a quarter of its value at RZ = 0, but at least 0.02.</source>
        <translation>Plus petite condition permise ; auto : en chaque point un quart de sa valeur à RZ = 0, mais au moins 0.02.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/joint_path.py"/>
        <source>Smallest condition of the Jacobian while depositing.</source>
        <translation>Plus petite condition du jacobien pendant le dépôt.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>So many layers under tops and over bottoms are filled at 100 %.</source>
        <translation>Nombre de couches remplies à 100 % sous les faces supérieures et au-dessus des faces inférieures.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Solids that touch or overlap are deposited as one (auto), or each by itself (none).</source>
        <translation>Les solides qui se touchent ou se recouvrent sont déposés comme un seul (auto), ou chacun pour soi (none).</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Speed between beads.</source>
        <translation>Vitesse entre les cordons.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Speed of the torch along the deposit while depositing.</source>
        <translation>Vitesse de la torche le long du dépôt.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Speed of the torch there. (mm/s)</source>
        <translation>Vitesse de la torche à cet endroit. (mm/s)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Speed of the wire: constant, or in proportion to the travel speed that a bead model sets, so that beads keep their section.</source>
        <translation>Vitesse du fil : constante, ou proportionnelle à la vitesse d&apos;avance que règle un modèle de cordon, pour que les cordons gardent leur section.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Speed of the wire; auto: what makes beads of their width and the layer height at the travel speed, or what the beads of the bead model were made with. 0: no wire. (mm/s)</source>
        <translation>Vitesse du fil ; auto : celle qui fait des cordons de leur largeur et de la hauteur de couche à la vitesse d&apos;avance, ou celle des cordons du modèle de cordon. 0 : pas de fil. (mm/s)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Stacking direction x y z in the part&apos;s coordinates, from the first layer to the last; auto: the one with the least area over nothing, of these the one with the least height.</source>
        <translation>Direction d&apos;empilement x y z dans les coordonnées de la pièce, de la première couche à la dernière ; auto : celle qui a le moins d&apos;aire au-dessus du vide, et parmi celles-ci la moins haute.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Stand-off of the nozzle; carried along. (mm)</source>
        <translation>Distance de la buse à la pièce ; transmise telle quelle. (mm)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/inspection.py"/>
        <source>Standard deviation of the deviations.</source>
        <translation>Écart type des écarts.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Temperature in degrees Celsius that a solid, or a wall, has to be below before its next layer; the torch waits above where that begins.</source>
        <translation>Température en degrés Celsius sous laquelle un solide, ou une paroi, doit être avant sa couche suivante ; la torche attend au-dessus de son départ.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Temperature in degrees Celsius; carried along.</source>
        <translation>Température en degrés Celsius ; transmise telle quelle.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/stage.py"/>
        <source>Template and values of message and findings, as JSON.</source>
        <translation>Modèles et valeurs du message et des constats, en JSON.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/joint_path.py"/>
        <source>The cell that runs it.</source>
        <translation>La cellule qui l&apos;exécute.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/toolpath.py"/>
        <source>The cell, for the clearance of nozzle and platform.</source>
        <translation>La cellule, pour le dégagement de la buse et du plateau.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>The controller the program is written for, or none.</source>
        <translation>La commande pour laquelle le programme est écrit, ou none.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/program.py"/>
        <source>The controller&apos;s files; double-click to read and export them.</source>
        <translation>Les fichiers de la commande ; double-cliquez pour les lire et les exporter.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/developable_feature.py"/>
        <source>The cylinders and cones of the hub to grow on; found when left out.</source>
        <translation>Les cylindres et cônes du moyeu sur lesquels croître ; trouvés s&apos;ils sont omis.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>The deposit is switched on the move itself, this long before a bead&apos;s start or end is reached: the time that its equipment takes. None: where the robot stands. (s)</source>
        <translation>Le dépôt est commuté pendant le mouvement même, ce temps avant que le début ou la fin d&apos;un cordon soit atteint : celui que met son équipement. Sans indication : là où le robot est à l&apos;arrêt. (s)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/solid_feature.py"/>
        <source>The edges, wire or sketch that layers along a guide stand normal to; none: the centre line of the solid.</source>
        <translation>Les arêtes, le fil ou l&apos;esquisse auxquels les couches le long d&apos;un guide sont normales ; aucun : la ligne médiane du solide.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/curves_feature.py"/>
        <source>The edges, wire, sketch or table of points to lay as beads; faces beside edges give the directions.</source>
        <translation>Les arêtes, le fil, l&apos;esquisse ou le tableau de points à déposer en cordons ; des faces à côté des arêtes donnent les directions.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/solid_feature.py"/>
        <source>The faces on which the first of geodesic and offset layers lies; none: where they stand.</source>
        <translation>Les faces sur lesquelles repose la première des couches géodésiques ou décalées ; aucune : là où elles sont posées.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/cladding_feature.py"/>
        <source>The faces to cover.</source>
        <translation>Les faces à recouvrir.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/toolpath.py"/>
        <source>The feature to deposit.</source>
        <translation>L&apos;élément à déposer.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/inspection.py"/>
        <source>The feature, toolpath, or object with a shape or mesh that was measured.</source>
        <translation>L&apos;élément, la trajectoire d&apos;outil, ou l&apos;objet à forme ou maillage qui a été mesuré.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/inspection.py"/>
        <source>The file of measured points or of a scanned mesh.</source>
        <translation>Le fichier des points mesurés ou d&apos;un maillage numérisé.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/developable_feature.py"/>
        <source>The hub; none is needed where it is one of the solids, or the base is given by numbers.</source>
        <translation>Le moyeu ; inutile s&apos;il est l&apos;un des solides, ou si la base est donnée par des nombres.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>The input&apos;s value in a program at 0 degrees Celsius.</source>
        <translation>Valeur de l&apos;entrée dans un programme à 0 degré Celsius.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/program.py"/>
        <source>The joint path to write.</source>
        <translation>La trajectoire articulaire à écrire.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>The number of a schedule is set on a group output; named by the arc instructions, which then switch the deposit; or is that of a program that is called.</source>
        <translation>Le numéro d&apos;un programme de soudage est mis sur une sortie de groupe ; nommé par les instructions d&apos;arc, qui commutent alors le dépôt ; ou est celui d&apos;un programme appelé.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/curves_feature.py"/>
        <source>The part that they are laid on; none is needed on a platform.</source>
        <translation>La pièce sur laquelle ils sont déposés ; inutile sur un plateau.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/solid_feature.py"/>
        <source>The part that they stand on; none is needed on a platform.</source>
        <translation>La pièce sur laquelle ils reposent ; aucune n&apos;est nécessaire sur un plateau.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/table_part.py"/>
        <source>The points as they were read.</source>
        <translation>Les points tels qu&apos;ils ont été lus.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>The same layer of all solids on a base in turn, around the axis, the same ring of each and the inner ones first; or solid by solid (feature).</source>
        <translation>La même couche de tous les solides d&apos;une base tour à tour, autour de l&apos;axe, le même anneau de chacun et les intérieurs d&apos;abord ; ou solide par solide (feature).</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>The same motion without deposit.</source>
        <translation>Le même mouvement sans dépôt.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/scan.py"/>
        <source>The scan was made after this layer, counted from 0: the layers above are fitted to it; none: it is of the bare substrate.</source>
        <translation>La numérisation a été faite après cette couche, comptée à partir de 0 : les couches au-dessus y sont ajustées ; aucune : elle est du substrat nu.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/feature.py"/>
        <source>The shape to deposit, or some of its faces.</source>
        <translation>La forme à déposer, ou certaines de ses faces.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>The side of the faces that is covered: where their normals point, outwards of a solid (front), or the other side of faces that are of no solid (back).</source>
        <translation>Le côté des faces qui est recouvert : celui vers lequel pointent leurs normales, l&apos;extérieur d&apos;un solide (front), ou l&apos;autre côté de faces qui ne sont d&apos;aucun solide (back).</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/surface_feature.py"/>
        <source>The solid part or closed mesh that the wall grows on; none is needed where edges are chosen.</source>
        <translation>La pièce solide ou le maillage fermé sur lequel croît la paroi ; inutile si des arêtes sont choisies.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/solid_feature.py"/>
        <source>The solids or closed meshes to deposit.</source>
        <translation>Les solides ou maillages fermés à déposer.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/developable_feature.py"/>
        <source>The solids or closed meshes to deposit; or a part and the faces of its hub, where both are one solid.</source>
        <translation>Les solides ou maillages fermés à déposer ; ou une pièce et les faces de son moyeu, si les deux sont un seul solide.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/developable_feature.py"/>
        <source>The surfaces that solids stand on.</source>
        <translation>Les surfaces sur lesquelles reposent les solides.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/joint_path.py"/>
        <source>The toolpath to run.</source>
        <translation>La trajectoire d&apos;outil à exécuter.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/surface_feature.py"/>
        <source>The wall to deposit, or its faces.</source>
        <translation>La paroi à déposer, ou ses faces.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/joint_path.py"/>
        <source>Time of all moves (s).</source>
        <translation>Temps de tous les mouvements (s).</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/joint_path.py"/>
        <source>Time of depositing moves (s).</source>
        <translation>Temps des mouvements de dépôt (s).</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/joint_path.py"/>
        <source>Time of the whole job with lead times and waits between layers (s).</source>
        <translation>Temps de tout le travail avec avances, retards et attentes entre les couches (s).</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/views/hub.py"/>
        <source>Tint the cylinders and cones that solids stand on.</source>
        <translation>Teinter les cylindres et cônes sur lesquels reposent les solides.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/views/feature.py"/>
        <source>Tint the faces of a wall on a substrate.</source>
        <translation>Teinter les faces d&apos;une paroi sur un substrat.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/build_direction.py"/>
        <source>Tool axis turned forward along the bead, from the build direction.</source>
        <translation>Axe de l&apos;outil tourné vers l&apos;avant le long du cordon, à partir de la direction de dépôt.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/build_direction.py"/>
        <source>Tool axis turned sideways, towards the outside of the wall, from the build direction.</source>
        <translation>Axe de l&apos;outil tourné de côté, vers l&apos;extérieur de la paroi, à partir de la direction de dépôt.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>Tool on robot only: points of the part and where the tip has touched them, three or more, which take the place of the deposition point, such as: 0 0 0 = 900.4 2.1 -99.7; 100 0 0 = 1000.3 1.2 -99.9; 0 80 0 = 901 82 -99.5. In the part file and in the maker&apos;s base frame, mm.</source>
        <translation>Outil sur le robot seulement : points de la pièce et où la pointe les a palpés, trois ou plus, qui remplacent le point de dépôt, par exemple : 0 0 0 = 900.4 2.1 -99.7 ; 100 0 0 = 1000.3 1.2 -99.9 ; 0 80 0 = 901 82 -99.5. Dans le fichier de la pièce et dans le repère de base du constructeur, en mm.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>Tool on robot only: pose of the tip on the flange, its Z pointing out of the nozzle. mm, RX RY RZ.</source>
        <translation>Outil sur le robot seulement : pose du bout sur la bride, son Z pointant hors de la buse. mm, RX RY RZ.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Torch turned outwards about the bead on outer contours.</source>
        <translation>Torche tournée vers l&apos;extérieur autour du cordon sur les contours extérieurs.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>Turn of the bead within the wall that smooth layers stay below where the band allows. (deg/mm)</source>
        <translation>Rotation du cordon dans la paroi au-dessous de laquelle restent les couches smooth là où la bande le permet. (deg/mm)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/inspection.py"/>
        <source>Unit of the measured coordinates; auto: the one that the file names, else mm.</source>
        <translation>Unité des coordonnées mesurées ; auto : celle que nomme le fichier, sinon mm.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>Value of that output at 1 m/min of wire.</source>
        <translation>Valeur de cette sortie à 1 m/min de fil.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/stage.py"/>
        <source>Version of these properties.</source>
        <translation>Version de ces propriétés.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/joint_path.py"/>
        <source>Volume of the deposit, bead width times layer height (cm³).</source>
        <translation>Volume du dépôt, largeur de cordon fois hauteur de couche (cm³).</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>What a joint path is judged by.</source>
        <translation>Ce qui juge une trajectoire articulaire.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>What differs for classes of beads (first_layer, contour, fill, closing, link, wall), such as: contour: travel_speed 8, schedule 3; fill: lead 5; or none.</source>
        <translation>Ce qui diffère pour des classes de cordons (first_layer, contour, fill, closing, link, wall), par exemple : contour : travel_speed 8, schedule 3 ; fill : lead 5 ; ou none.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/stage.py"/>
        <source>What is where in the arrays.</source>
        <translation>Ce qui est où dans les tableaux.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/stage.py"/>
        <source>What is wrong, and what to do.</source>
        <translation>Ce qui ne va pas, et que faire.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/views/joint_path.py"/>
        <source>What the colours of the beads show.</source>
        <translation>Ce que disent les couleurs des cordons.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/table_part.py"/>
        <source>What the file is.</source>
        <translation>Ce qu&apos;est le fichier.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>What the layers are: parallel planes; at equal distances by the way through the part from where it stands, so that nothing needs support (geodesic); at equal distances straight from there (offset); or planes normal to a guide curve (along).</source>
        <translation>Ce que sont les couches : des plans parallèles ; à distances égales par le chemin à travers la pièce depuis là où elle repose, de sorte que rien n&apos;a besoin de support (geodesic) ; à distances égales en ligne droite depuis là (offset) ; ou des plans normaux à une courbe guide (along).</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/stage.py"/>
        <source>What the object is, should its proxy be lost.</source>
        <translation>Ce qu&apos;est l&apos;objet, si son proxy était perdu.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>What the polynomial gives: the true rotation about the tool axis, or RZ of the paper.</source>
        <translation>Ce que donne le polynôme : la vraie rotation autour de l&apos;axe de l&apos;outil, ou le RZ de l&apos;article.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>What the positions of Cartesian programs are relative to, in the part&apos;s coordinates: x y z mm, RX RY RZ deg; auto: the frame that sits on the platform.</source>
        <translation>À quoi se rapportent les positions des programmes cartésiens, dans les coordonnées de la pièce : x y z mm, RX RY RZ deg ; auto : le repère qui repose sur le plateau.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/inspection.py"/>
        <source>What was in the file.</source>
        <translation>Ce qui était dans le fichier.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Where beads start: where the seam says (aligned), or apart from those of neighbouring contours and layers, lines of every second layer at their other end (spread).</source>
        <translation>Départ des cordons : où le dit la couture (alignés), ou loin de ceux des contours et couches voisins, les lignes d&apos;une couche sur deux par leur autre bout (répartis).</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Where closed beads start.</source>
        <translation>Là où commencent les cordons fermés.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Where in its height a layer takes its outline from the part.</source>
        <translation>À quelle hauteur une couche prend son contour de la pièce.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>Where it takes less motion than a polynomial, the rotation about the tool axis is free at every point of a bead: the best course that is found, for the objective displacement. Takes up to seconds per bead.</source>
        <translation>Là où le mouvement est moindre qu’avec un polynôme, la rotation autour de l’axe de l’outil est libre en chaque point d’un cordon : le meilleur parcours trouvé, pour l’objectif displacement. Prend jusqu’à quelques secondes par cordon.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Where the figures of the material are from; carried to the report.</source>
        <translation>D&apos;où viennent les valeurs du matériau ; repris dans le rapport.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/inspection.py"/>
        <source>Where the fit begins: three or more pairs of a measured point and the same point of the part, each x y z &gt; x y z in mm, with a semicolon between; empty: it is searched for.</source>
        <translation>Là où commence l&apos;ajustement : trois paires ou plus d&apos;un point mesuré et du même point de la pièce, chacune x y z &gt; x y z en mm, séparées par un point-virgule ; vide : il est cherché.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>Where the locked axis stands; auto: where the largest angle left is least. (deg)</source>
        <translation>Là où se tient l&apos;axe bloqué ; auto : là où le plus grand angle restant est le plus petit. (deg)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/stage.py"/>
        <source>Whether the result fits.</source>
        <translation>Si le résultat correspond.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>Which frame sits on the platform: the feature&apos;s own, or that of the part file.</source>
        <translation>Quel repère repose sur le plateau : celui de l&apos;élément à déposer, ou celui du fichier de la pièce.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>Which of part and tool the robot carries, or a machine with rotary axes.</source>
        <translation>Ce que porte le robot, la pièce ou l&apos;outil, ou une machine à axes rotatifs.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>Which of the controller&apos;s external axes e1 is; the others follow: eax_a, E1 are 1.</source>
        <translation>Lequel des axes externes de la commande est e1 ; les autres suivent : eax_a, E1 sont 1.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>Which set of joint limits of the machine file holds.</source>
        <translation>Quel jeu de limites articulaires du fichier machine vaut.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/inspection.py"/>
        <source>Which side of a wall was measured: that of its outer normals, the inner one, or both.</source>
        <translation>Quel côté d&apos;une paroi a été mesuré : celui de ses normales extérieures, l&apos;intérieur, ou les deux.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>Which wall of a solid is deposited; middle runs halfway between outer and inner.</source>
        <translation>Quelle paroi d&apos;un solide est déposée ; middle court à mi-chemin entre l&apos;extérieure et l&apos;intérieure.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Widest gap that may stay open between beads, as a share of the bead spacing. (%)</source>
        <translation>Plus large jour qui peut rester ouvert entre les cordons, en part de la distance des cordons. (%)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Width of the bead; held by the bead model. Solids on hubs are filled with beads that wide.</source>
        <translation>Largeur du cordon ; tenue par le modèle de cordon. Les solides sur moyeux sont remplis de cordons de cette largeur.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/path_view.py"/>
        <source>Width of the beads&apos; lines in pixels.</source>
        <translation>Largeur des lignes des cordons en pixels.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/inspection.py"/>
        <source>Width of the narrowest zone between two circles, by height.</source>
        <translation>Largeur de la zone la plus étroite entre deux cercles, par hauteur.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/inspection.py"/>
        <source>Width of the narrowest zone between two spheres that holds all points.</source>
        <translation>Largeur de la zone la plus étroite entre deux sphères qui contient tous les points.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/build_direction.py"/>
        <source>local: tangent to the wall at each point; layer: one direction per layer; fixed: the axis of the part.</source>
        <translation>local : tangente à la paroi en chaque point ; layer : une direction par couche ; fixed : l&apos;axe de la pièce.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/build_direction.py"/>
        <source>nozzle: tilt no more than needed to keep the nozzle clear of deposit and platform.</source>
        <translation>nozzle : pas plus d&apos;inclinaison qu&apos;il n&apos;en faut pour tenir la buse éloignée du dépôt et du plateau.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/surface_feature.py"/>
        <source>torus, cone (cylinders too) or table; patches for a wall of any connected faces; mesh.</source>
        <translation>tore, cône (cylindres aussi) ou table ; patches pour une paroi de faces quelconques qui se tiennent ; mesh.</translation>
    </message>
</context>
<context>
    <name>RoboticAM</name>
    <message>
        <location filename="../../freecad_am/gui/widgets/fields.py"/>
        <source> or </source>
        <translation> ou </translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/kuka/post.py"/>
        <source>$OUT[{0}] to $OUT[{1}] carry the schedule, and one of them switches the deposit; use other ones, or another program.deposit_output</source>
        <translation>$OUT[{0}] à $OUT[{1}] transmettent le programme de soudage, et l&apos;une d&apos;elles commute le dépôt ; prenez-en d&apos;autres, ou un autre program.deposit_output</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/fields.py"/>
        <source>(empty: none)</source>
        <translation>(vide : aucune)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/on_bends.py"/>
        <source>(others stand on the bend of {0}: as the substrate it gives them layers of its shape)</source>
        <translation>(les autres reposent sur la courbure de {0} : comme substrat il leur donne des couches de sa forme)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/controls.py"/>
        <source>(planned)</source>
        <translation>(planifié)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/poses_page.py"/>
        <source>, and </source>
        <translation>, et </translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/model/predicted.py"/>
        <source>. At one wire feed faster stretches are lower; process.wire.feed_mode: proportional would keep the section, at {0} to {1} mm/s of wire</source>
        <translation>. Au même dévidage les passages plus rapides sont plus bas ; process.wire.feed_mode: proportional garderait la section, à {0} à {1} mm/s de fil</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/model/predicted.py"/>
        <source>. The wire runs in proportion to the speed, at {0} to {1} mm/s, and keeps their section</source>
        <translation>. Le fil court en proportion de la vitesse, de {0} à {1} mm/s, et garde leur section</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/slicing/solids/standing.py"/>
        <source>. Times {0} it would reach {1}: is its file in {2}? Then export it in mm, or give scale: {3} mm with it, as part.scale (in the window: Meshes, Scale)</source>
        <translation>. Multiplié par {0} il atteindrait {1} : son fichier est-il en {2} ? Alors exportez-le en mm, ou donnez `scale: {3} mm` avec lui, comme part.scale (dans la fenêtre : Maillages, Échelle)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/promise.py"/>
        <source>0 points</source>
        <translation>0 point</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/promise.py"/>
        <source>0 rapids</source>
        <translation>0 rapide</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/source_page.py"/>
        <source>0, or 1 where the joint slides along z: a machine with rotary axes has three of them</source>
        <translation>0, ou 1 si l&apos;articulation glisse le long de z : une machine à axes rotatifs en a trois</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/cladding.py"/>
        <source>1 face</source>
        <translation>1 face</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/promise.py"/>
        <source>1 point</source>
        <translation>1 point</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/promise.py"/>
        <source>1 rapid</source>
        <translation>1 rapide</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/hub.py"/>
        <source>1 solid on {1} ({2})</source>
        <translation>1 solide sur {1} ({2})</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/solid.py"/>
        <source>1 solid, {:.4g} mm high</source>
        <translation>1 solide, {:.4g} mm de haut</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/source_page.py"/>
        <source>1, or -1 where the joint moves the other way</source>
        <translation>1, ou -1 si l&apos;articulation va dans l&apos;autre sens</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/table.py"/>
        <source>95 % of the amounts within</source>
        <translation>95 % des écarts absolus sous</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/beads/speeds.py"/>
        <source>: it is up to {0} mm wider there and {1} mm higher, by the bead model</source>
        <translation>: il y est jusqu&apos;à {0} mm plus large et {1} mm plus haut, d&apos;après le modèle de cordon</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/beads/speeds.py"/>
        <source>: it is up to {0} mm wider there and {1} mm higher, by the bead model; slower than {2} mm/s nothing was measured</source>
        <translation>: il y est jusqu&apos;à {0} mm plus large et {1} mm plus haut, d&apos;après le modèle de cordon ; au-dessous de {2} mm/s rien n&apos;a été mesuré</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/beads/speeds.py"/>
        <source>: it is up to {0} mm wider there, by the bead model</source>
        <translation>: il y est jusqu&apos;à {0} mm plus large, d&apos;après le modèle de cordon</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/beads/speeds.py"/>
        <source>: it is up to {0} mm wider there, by the bead model; slower than {1} mm/s nothing was measured</source>
        <translation>: il y est jusqu&apos;à {0} mm plus large, d&apos;après le modèle de cordon ; au-dessous de {1} mm/s rien n&apos;a été mesuré</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/patch_wall.py"/>
        <source>; between the edges of its triangles it runs smoothly, up to {0} mm off them, about as far as they are off what they stand for</source>
        <translation>; entre les arêtes de ses triangles elle court régulièrement, à {0} mm d&apos;eux au plus, à peu près autant qu&apos;ils s&apos;écartent de ce qu&apos;ils représentent</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/urdf/collision.py"/>
        <source>&lt;{0}&gt; has a size that is not larger than 0; give its sizes in m</source>
        <translation>&lt;{0}&gt; a une taille qui n’est pas supérieure à 0 ; donnez ses dimensions en m</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/urdf/elements.py"/>
        <source>&lt;{0}&gt; has no &lt;{1}&gt;; add it</source>
        <translation>&lt;{0}&gt; n&apos;a pas de &lt;{1}&gt; ; ajoutez-le</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/urdf/elements.py"/>
        <source>&lt;{0}&gt; has no {1}; add it</source>
        <translation>&lt;{0}&gt; n&apos;a pas de {1} ; ajoutez-le</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/urdf/elements.py"/>
        <source>&lt;{0}&gt; {1} has no &lt;{2}&gt;; add it</source>
        <translation>&lt;{0}&gt; {1} n&apos;a pas de &lt;{2}&gt; ; ajoutez-le</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/source_page.py"/>
        <source>A URDF file</source>
        <translation>Un fichier URDF</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/program/window.py"/>
        <source>A click shows the point of a line in the path; a click on the path marks its line</source>
        <translation>Un clic montre le point d&apos;une ligne dans la trajectoire ; un clic sur la trajectoire marque sa ligne</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/source_page.py"/>
        <source>A copy of another machine</source>
        <translation>Une copie d&apos;une autre machine</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/preferences/page.py"/>
        <source>A further folder of machine files, such as one that is shared; your own are in {} as well</source>
        <translation>Un autre dossier de fichiers machine, comme un dossier partagé ; les vôtres sont aussi dans {}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/cladding.py"/>
        <source>A further part that the nozzle is kept clear of.</source>
        <translation>Une pièce supplémentaire que la buse évite.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/consequences.py"/>
        <source>A joint would have to be at {:.0f} % of its speed: the planner will slow it, or refuse</source>
        <translation>Une articulation devrait aller à {:.0f} % de sa vitesse : le planificateur la ralentira, ou refusera</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>A machine of the list, or the path of a machine file.</source>
        <translation>Une machine de la liste, ou le chemin d&apos;un fichier machine.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/new_job/proposal.py"/>
        <source>A part of revolution needs exact faces; {} is a mesh.</source>
        <translation>Une pièce de révolution demande des faces exactes ; {} est un maillage.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>A region narrower than a bead gets a single bead, or the job is refused.</source>
        <translation>Une région plus étroite qu&apos;un cordon reçoit un seul cordon, ou le travail est refusé.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/post.py"/>
        <source>A stop of the program switches the deposit off</source>
        <translation>Un arrêt du programme coupe le dépôt</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/feature.py"/>
        <source>A straight edge, sketch axis or datum line to turn about, where the shape has none. A sketch is turned about its vertical axis unless another one is chosen.</source>
        <translation>Une arête droite, un axe d&apos;esquisse ou une ligne de référence autour de laquelle tourner, si la forme n&apos;en a pas. Une esquisse tourne autour de son axe vertical, sauf si un autre est choisi.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/source_page.py"/>
        <source>A table of Denavit and Hartenberg</source>
        <translation>Un tableau de Denavit et Hartenberg</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/yaskawa/post.py"/>
        <source>AOUT between two moves of an INFORM job is set when its line is reached, which rounded corners move</source>
        <translation>AOUT entre deux mouvements d&apos;un job INFORM est réglé quand sa ligne est atteinte, ce que les coins arrondis déplacent</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/fanuc/post.py"/>
        <source>AO[] between two moves of a FANUC is set when its line is read, ahead of the motion</source>
        <translation>AO[] entre deux mouvements d&apos;un FANUC est réglé à la lecture de sa ligne, avant le mouvement</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/revolution.py"/>
        <source>About {} turns along {:.4g} mm of wall</source>
        <translation>Environ {} tours le long de {:.4g} mm de paroi</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/limits_page.py"/>
        <source>Acceleration</source>
        <translation>Accélération</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/controls.py"/>
        <source>Across</source>
        <translation>En travers</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/feature_order.py"/>
        <source>Add</source>
        <translation>Ajouter</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Adds a cell: machine, set-up, platform and nozzle</source>
        <translation>Ajoute une cellule : machine, installation, plateau et buse</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/feature_order.py"/>
        <source>Adds the features selected, else the next one of the document</source>
        <translation>Ajoute les éléments sélectionnés, sinon le suivant du document</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/source_page.py"/>
        <source>After</source>
        <translation>Après</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/scan.py"/>
        <source>After layer</source>
        <translation>Après la couche</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>Against gravity, as x y z in the world.</source>
        <translation>À l&apos;opposé de la pesanteur, sous la forme x y z dans le monde.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/controls.py"/>
        <source>All beads together</source>
        <translation>Tous les cordons ensemble</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/joint_path.py"/>
        <source>All deposit points can be carried out.</source>
        <translation>Tous les points de dépôt sont réalisables.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/inspection/inputs.py"/>
        <source>All files</source>
        <translation>Tous les fichiers</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/deposit.py"/>
        <source>All of the part is deposited</source>
        <translation>Toute la pièce est déposée</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/consequences.py"/>
        <source>All points serve</source>
        <translation>Tous les points conviennent</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/whats_this.py"/>
        <source>All tools</source>
        <translation>Tous les outils</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>Allowed rotation about the tool axis; a full turn means free, narrower for a torch that is not coaxial.</source>
        <translation>Rotation permise autour de l&apos;axe de l&apos;outil ; un tour entier veut dire libre, moins pour une torche qui n&apos;est pas coaxiale.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/fields.py"/>
        <source>Allowed: {}.</source>
        <translation>Permis : {}.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/dock.py"/>
        <source>Along the time of the job, or along its path</source>
        <translation>Le long du temps du travail, ou le long de sa trajectoire</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/fanuc/post.py"/>
        <source>An axis without limits has the Continuous Turn option</source>
        <translation>Un axe sans limites a l’option Continuous Turn</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/toolpath.py"/>
        <source>An inspection of the substrate by a scan of it, which the first layers are fitted to.</source>
        <translation>Un contrôle du substrat par sa numérisation, sur laquelle les premières couches sont ajustées.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>Analogue output for the speed of the wire where it follows the travel speed.</source>
        <translation>Sortie analogique qui dit la vitesse du fil là où elle suit la vitesse d&apos;avance.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Angle</source>
        <translation>Angle</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>Angle between the nozzle&apos;s axis and its side.</source>
        <translation>Angle entre l&apos;axe de la buse et son flanc.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/place.py"/>
        <source>Angle step</source>
        <translation>Pas angulaire</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/source_page.py"/>
        <source>Angle that is added to the joint&apos;s, deg</source>
        <translation>Angle ajouté à celui de l&apos;articulation, deg</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/stage.py"/>
        <source>Another task panel is open; close it first.</source>
        <translation>Un autre panneau de tâche est ouvert ; fermez-le d&apos;abord.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/process.py"/>
        <source>ArcL is a linear move, and these are joint moves, which motion: cartesian replaces</source>
        <translation>ArcL est un mouvement linéaire, et ceux-ci sont des mouvements articulaires, que motion: cartesian remplace</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/kuka/arc.py"/>
        <source>ArcTech ends the arc with the last move of a bead and stays there for the crater time of its weld data; use lead_off 0 and set the crater time of {0}, or another program.schedule.by</source>
        <translation>ArcTech termine l&apos;arc avec le dernier mouvement d&apos;un cordon et y reste le temps de cratère de ses données de soudage ; employez lead_off 0 et réglez le temps de cratère de {0}, ou un autre program.schedule.by</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/cladding_feature.py"/>
        <source>Area of the faces.</source>
        <translation>Aire des faces.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>Arm clearance</source>
        <translation>Dégagement du bras</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/placement/figures.py"/>
        <source>Arm clearance, mm</source>
        <translation>Distance du bras, mm</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/consequences.py"/>
        <source>As planned</source>
        <translation>Comme planifié</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/placement/figures.py"/>
        <source>At most {:.0f} % of the points are served: {}.</source>
        <translation>Au plus {:.0f} % des points sont desservis : {}.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>Axes</source>
        <translation>Axes</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/frames_page.py"/>
        <source>Axes on the pendant: -1 where it counts the other way; what it shows at zero</source>
        <translation>Axes sur le pupitre : -1 là où il compte dans l&apos;autre sens ; ce qu&apos;il montre à zéro</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/feature.py"/>
        <source>Axis</source>
        <translation>Axe</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/source_page.py"/>
        <source>Axis 2 is a1 ahead of axis 1 and c1 above the base; c2 to axis 3; axis 4 is a2 from axis 3 (negative: above it), b to the side; c3 to the wrist centre, c4 to the flange. The angle of the arm is q · sign - offset; at zero it stretches straight up.</source>
        <translation>L&apos;axe 2 est à a1 devant l&apos;axe 1 et à c1 au-dessus de la base ; c2 jusqu&apos;à l&apos;axe 3 ; l&apos;axe 4 est à a2 de l&apos;axe 3 (négatif : au-dessus de lui), b de côté ; c3 jusqu&apos;au centre du poignet, c4 jusqu&apos;à la bride. L&apos;angle du bras est q · signe - décalage ; à zéro il se tend droit vers le haut.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/frames_page.py"/>
        <source>Axis 3 is shown against link 2, as it is</source>
        <translation>L&apos;axe 3 est montré par rapport au corps 2, tel qu&apos;il est</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/frames_page.py"/>
        <source>Axis 3 is shown against the horizontal (FANUC, some of ABB)</source>
        <translation>L&apos;axe 3 est montré par rapport à l&apos;horizontale (FANUC, certains ABB)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>Axis that stands still</source>
        <translation>Axe à l&apos;arrêt</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/kuka/post.py"/>
        <source>BASE_DATA and TOOL_DATA of the numbers in the program are those of the cell, with their load</source>
        <translation>Les BASE_DATA et TOOL_DATA des numéros du programme sont ceux de la cellule, avec leur charge</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/form.py"/>
        <source>Back</source>
        <translation>Retour</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/simulation/fields.py"/>
        <source>Back to the start of the layer</source>
        <translation>Retour au début de la couche</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>Band</source>
        <translation>Bande</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/frames_page.py"/>
        <source>Base</source>
        <translation>Base</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/developable_feature.py"/>
        <source>Base faces</source>
        <translation>Faces de base</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/frames_page.py"/>
        <source>Base: the maker&apos;s own base frame, in which the pendant shows positions, seen from the floor plate. FANUC&apos;s lies at the height of axis 2. Flange: in the last link, its Z out of the plate. Rotation: about X, then Y, then Z.</source>
        <translation>Base : le repère de base du constructeur, dans lequel le pupitre dit les positions, vu de la plaque au sol. Celui de FANUC est à la hauteur de l&apos;axe 2. Bride : dans le dernier corps, son Z hors de la plaque. Rotation : autour de X, puis Y, puis Z.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/controls.py"/>
        <source>Bead</source>
        <translation>Cordon</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Bead model</source>
        <translation>Modèle de cordon</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Bead overlap</source>
        <translation>Recouvrement des cordons</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Bead spacing</source>
        <translation>Distance des cordons</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>Bead turn</source>
        <translation>Rotation par cordon</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Bead width</source>
        <translation>Largeur de cordon</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Beads that close gaps are made no shorter than this; others that are shorter are left out. auto: 2 mm, or the bead spacing where that is less.</source>
        <translation>Les cordons qui comblent des jours ne sont pas plus courts que cela ; les autres plus courts sont laissés de côté. auto : 2 mm, ou l&apos;espacement des cordons s&apos;il est plus petit.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/source_page.py"/>
        <source>Before</source>
        <translation>Avant</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/program.py"/>
        <source>Begins with {}. Lines: {}, files: {}</source>
        <translation>Commence par {}. Lignes : {}, fichiers : {}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Below</source>
        <translation>Au-dessous de</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/source_page.py"/>
        <source>Beside the robot of this file, in its base frame, as a cell names it: NAME {}</source>
        <translation>À côté du robot de ce fichier, dans son repère de base, comme une cellule le nomme : NOM {}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/place.py"/>
        <source>Best</source>
        <translation>Meilleure</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/written.py"/>
        <source>Between its points the text keeps to the planned path</source>
        <translation>Entre ses points, le texte suit la trajectoire planifiée</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Between layers</source>
        <translation>Entre les couches</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/place.py"/>
        <source>Between two values of RX, RY or RZ.</source>
        <translation>Entre deux valeurs de RX, RY ou RZ.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/place.py"/>
        <source>Between two values of x, y or z.</source>
        <translation>Entre deux valeurs de x, y ou z.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>Blend</source>
        <translation>Lissage</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/controls.py"/>
        <source>Branch</source>
        <translation>Branche</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>Branch of this path</source>
        <translation>Branche de cette trajectoire</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/source_page.py"/>
        <source>Browse…</source>
        <translation>Parcourir…</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/feature.py"/>
        <source>Build direction</source>
        <translation>Direction de dépôt</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/form.py"/>
        <source>Build directions</source>
        <translation>Directions de dépôt</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>By</source>
        <translation>Par</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/fields.py"/>
        <source>By default: {}.</source>
        <translation>Par défaut : {}.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>By how much the input&apos;s value in a program rises with a degree.</source>
        <translation>De combien la valeur de l&apos;entrée dans un programme monte par degré.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/interop/cam_path.py"/>
        <source>CAM (Path)</source>
        <translation>CAM (Path)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/interop/cam_path.py"/>
        <source>CAM path</source>
        <translation>trajectoire CAM</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/export_path.py"/>
        <source>CAM path in this document</source>
        <translation>Trajectoire CAM ici</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/export_path.py"/>
        <source>CSV table of waypoints</source>
        <translation>Tableau CSV de points</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/toolpath.py"/>
        <source>Calibration table</source>
        <translation>Tableau d&apos;étalonnage</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Call</source>
        <translation>Appel</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/background/busy.py"/>
        <source>Cancel</source>
        <translation>Annuler</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/placement/dock.py"/>
        <source>Cancelled.</source>
        <translation>Annulé.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/export_path.py"/>
        <source>Cancelled: nothing was made.</source>
        <translation>Annulé : rien n&apos;a été fait.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/cell/proposing.py"/>
        <source>Cancelled: the document is as it was.</source>
        <translation>Annulé : le document est tel qu&apos;il était.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/joint_path.py"/>
        <source>Cannot be carried out:</source>
        <translation>Irréalisable :</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/fanuc/post.py"/>
        <source>Cartesian motion with the part on the robot means remote TCP, and what the position records of such moves (RX RY RZ RW RP RR) stand for is not understood well enough to write them; use `motion: joint`</source>
        <translation>le mouvement cartésien avec la pièce sur le robot veut dire TCP distant, et ce que représentent les enregistrements de position de tels mouvements (RX RY RZ RW RP RR) n&apos;est pas assez compris pour les écrire ; utilisez `motion: joint`</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/fanuc/numbers.py"/>
        <source>Cartesian positions are written only of an arm reaching forwards; use `branch: [front, ...]` or `motion: joint`</source>
        <translation>les positions cartésiennes ne sont écrites que pour un bras tendu vers l&apos;avant ; utilisez `branch: [front, ...]` ou `motion: joint`</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/cell.py"/>
        <source>Cell</source>
        <translation>Cellule</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/new_job/panel.py"/>
        <source>Cell, feature, toolpath, joint path and program are made with their defaults; double-click one in the tree to change it.</source>
        <translation>Cellule, élément, trajectoire d&apos;outil, trajectoire articulaire et programme sont faits avec leurs valeurs par défaut ; double-cliquez sur l&apos;un d&apos;eux dans l&apos;arbre pour le modifier.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/context_menu.py"/>
        <source>Cells</source>
        <translation>Cellules</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Cell…</source>
        <translation>Cellule…</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>Certificate</source>
        <translation>Certificat</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/readout.py"/>
        <source>Certificate: {:.4g} as planned, no rotation goes below {:.4g}: a gap of {:.1f} %, {:.1f} % in layer {} bead {}</source>
        <translation>Certificat : {:.4g} tel que planifié, aucune rotation ne descend sous {:.4g} : un écart de {:.1f} %, de {:.1f} % dans la couche {} cordon {}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>Change of the objective and of the coefficients at which the optimiser stops.</source>
        <translation>Variation de l&apos;objectif et des coefficients à laquelle l&apos;optimiseur s&apos;arrête.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/poses_page.py"/>
        <source>Changes the conventions so; poses stay as they were typed</source>
        <translation>Change ainsi les conventions ; les poses restent telles que saisies</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>Characteristic length</source>
        <translation>Longueur caractéristique</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/poses_page.py"/>
        <source>Check poses</source>
        <translation>Poses de contrôle</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/toolpath.py"/>
        <source>Choose a table…</source>
        <translation>Choisir un tableau…</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/export_path.py"/>
        <source>Choose the file</source>
        <translation>Choisir le fichier</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/inspection/inputs.py"/>
        <source>Choose the file of the measured points.</source>
        <translation>Choisissez le fichier des points mesurés.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/inspection/inputs.py"/>
        <source>Choose…</source>
        <translation>Choisir…</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>Chord error</source>
        <translation>Erreur de corde</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/table.py"/>
        <source>Circularity</source>
        <translation>Circularité</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/table.py"/>
        <source>Circularity defect at {0} mm</source>
        <translation>Défaut de circularité à {0} mm</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/table.py"/>
        <source>Circularity defect at {0} mm, least squares</source>
        <translation>Défaut de circularité à {0} mm, moindres carrés</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/cladding.py"/>
        <source>Cladding</source>
        <translation>Rechargement</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/new_job/panel.py"/>
        <source>Cladding of faces</source>
        <translation>Rechargement de faces</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Cladding…</source>
        <translation>Rechargement…</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/feature.py"/>
        <source>Clamps and other bodies around the part, which the nozzle is kept clear of.</source>
        <translation>Brides et autres corps autour de la pièce, dont la buse est tenue éloignée.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Classes</source>
        <translation>Classes</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/build_direction.py"/>
        <source>Clearance</source>
        <translation>Dégagement</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/picking/pick_field.py"/>
        <source>Clears it</source>
        <translation>Efface le choix</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/wall.py"/>
        <source>Click edges of one object.</source>
        <translation>Cliquez sur des arêtes d&apos;un seul objet.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/new_job/panel.py"/>
        <source>Click what is to be deposited, in the tree or the 3D view; then with Ctrl what it grows on, if there is such.</source>
        <translation>Cliquez sur ce qui est à déposer, dans l&apos;arbre ou la vue 3D ; puis avec Ctrl sur ce sur quoi cela croît, s&apos;il y a lieu.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/new_job/proposal.py"/>
        <source>Click, with Ctrl, the faces to cover.</source>
        <translation>Cliquez, avec Ctrl, sur les faces à couvrir.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/program/window.py"/>
        <source>Close</source>
        <translation>Fermer</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>Close gap</source>
        <translation>Combler l’écart</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/wizard.py"/>
        <source>Close without a machine file? What you entered on the pages is lost.</source>
        <translation>Fermer sans fichier de machine ? Ce que vous avez saisi dans les pages est perdu.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>Closed beads layer by layer, or one continuous spiral.</source>
        <translation>Cordons fermés couche par couche, ou une spirale continue.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/name_page.py"/>
        <source>Closed form (mm): {}</source>
        <translation>Forme explicite (mm) : {}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/program/window.py"/>
        <source>Closes this window</source>
        <translation>Ferme cette fenêtre</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/preferences/page.py"/>
        <source>Colour of machines</source>
        <translation>Couleur des machines</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/form.py"/>
        <source>Colours</source>
        <translation>Couleurs</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/preferences/page.py"/>
        <source>Colours of paths</source>
        <translation>Couleurs des trajectoires</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/dock.py"/>
        <source>Compare methods</source>
        <translation>Comparer les méthodes</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>Compare the joint path with a lower bound over all rotations about the tool axis. Takes up to seconds per bead.</source>
        <translation>Compare la trajectoire articulaire à une borne inférieure sur toutes les rotations autour de l’axe de l’outil. Prend jusqu’à quelques secondes par cordon.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>Compare with</source>
        <translation>Comparer avec</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/context_menu.py"/>
        <source>Compare with measured points…</source>
        <translation>Comparer à des points mesurés…</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Compares measured points with what was planned</source>
        <translation>Compare des points mesurés à ce qui était prévu</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>Compress</source>
        <translation>Compression</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/placement/dock.py"/>
        <source>Compute</source>
        <translation>Calculer</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/context_menu.py"/>
        <source>Compute again</source>
        <translation>Recalculer</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/placement/work.py"/>
        <source>Computing</source>
        <translation>Calcul</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/dock.py"/>
        <source>Computing…</source>
        <translation>Calcul en cours…</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>Condition</source>
        <translation>Condition</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>Condition of the Jacobian (0 is singular)</source>
        <translation>Condition du jacobien (0 est singulier)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/post.py"/>
        <source>Configuration supervision may be off (ConfL), and joint values mean what the machine file says</source>
        <translation>La surveillance des configurations peut être désactivée (ConfL), et les valeurs articulaires signifient ce que dit le fichier de machine</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Contour</source>
        <translation>Contour</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Contours are laid round lines and the like.</source>
        <translation>Des contours sont déposés autour des lignes et autres motifs.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Cooling</source>
        <translation>Refroidissement</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/controls.py"/>
        <source>Curve</source>
        <translation>Courbe</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/curves.py"/>
        <source>Curves</source>
        <translation>Courbes</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/new_job/panel.py"/>
        <source>Curves as beads</source>
        <translation>Courbes en cordons</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Curves…</source>
        <translation>Courbes…</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Cut at</source>
        <translation>Couper à</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/context_menu.py"/>
        <source>Cut into layers…</source>
        <translation>Découper en couches…</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Cuts a feature into layers and beads</source>
        <translation>Découpe un élément en couches et en cordons</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/export_path.py"/>
        <source>DXF file of polylines</source>
        <translation>Polylignes en DXF</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/inspection/panel.py"/>
        <source>Defects are widths of the narrowest zone, as ISO 1101 has them</source>
        <translation>Les défauts sont les largeurs de la zone la plus étroite, selon ISO 1101</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Deflection</source>
        <translation>Flèche</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/controls.py"/>
        <source>Degree</source>
        <translation>Degré</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>Degree of the polynomial of a layer.</source>
        <translation>Degré du polynôme d&apos;une couche.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/controls.py"/>
        <source>Degree of the polynomials</source>
        <translation>Degré des polynômes</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Density</source>
        <translation>Masse volumique</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/fields/preferences.py"/>
        <source>Density (g/cm³)</source>
        <translation>Masse volumique (g/cm³)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Density of the deposit in g/cm³, for its mass.</source>
        <translation>Masse volumique du dépôt en g/cm³ ; donne sa masse.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/new_job/panel.py"/>
        <source>Deposit</source>
        <translation>Déposer</translation>
    </message>
    <message>
        <location filename="../../freecad_am/plots/deviation.py"/>
        <source>Deposit beyond the faces</source>
        <translation>Dépôt au-delà des faces</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>Deposit off</source>
        <translation>Dépôt arrêt</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>Deposit on</source>
        <translation>Dépôt marche</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>Deposit output</source>
        <translation>Sortie de dépôt</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>Deposit rate</source>
        <translation>Débit de dépôt</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Deposit switched off this long after a bead ends.</source>
        <translation>Dépôt coupé ce temps après la fin d&apos;un cordon.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Deposit switched on this long before a bead starts.</source>
        <translation>Dépôt mis en marche ce temps avant le début d&apos;un cordon.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>Deposited mass</source>
        <translation>Masse déposée</translation>
    </message>
    <message>
        <location filename="../../freecad_am/plots/process.py"/>
        <source>Deposited of the part: {0} %</source>
        <translation>Déposé de la pièce : {0} %</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/simulation/wording.py"/>
        <source>Depositing</source>
        <translation>Dépôt en cours</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>Deposition point</source>
        <translation>Point de dépôt</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/feature_order.py"/>
        <source>Deposits the chosen feature earlier</source>
        <translation>Dépose plus tôt l&apos;élément choisi</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/feature_order.py"/>
        <source>Deposits the chosen feature later</source>
        <translation>Dépose plus tard l&apos;élément choisi</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/inspection.py"/>
        <source>Deviations up to this, outside or inside, are within tolerance.</source>
        <translation>Les écarts jusqu&apos;à cette valeur, vers l&apos;extérieur ou l&apos;intérieur, sont dans la tolérance.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>Diameter</source>
        <translation>Diamètre</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/table.py"/>
        <source>Diameter at {0} mm</source>
        <translation>Diamètre à {0} mm</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>Diameter of the nozzle&apos;s flat tip.</source>
        <translation>Diamètre du bout plat de la buse.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>Diameter of the platform; counts in clearance.</source>
        <translation>Diamètre du plateau ; compte dans le dégagement.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Diameter of the wire.</source>
        <translation>Diamètre du fil.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>Digital output that switches the deposit.</source>
        <translation>Sortie logique qui commande le dépôt.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Direction</source>
        <translation>Sens</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Direction of closed beads seen against the build direction; open beads run as found unless alternate.</source>
        <translation>Sens des cordons fermés vu contre la direction de dépôt ; les cordons ouverts courent tels que trouvés, sauf avec alternate.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Direction of lines and zigzags; 0 runs around the hub, 90 deg along it.</source>
        <translation>Direction des lignes et des zigzags ; 0 court autour du moyeu, 90 deg le long de celui-ci.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>Direction x y z from the deposit towards the tool, in the part&apos;s coordinates, where neither the curves nor faces say one.</source>
        <translation>Direction x y z du dépôt vers l&apos;outil, dans les coordonnées de la pièce, là où ni les courbes ni des faces n&apos;en indiquent.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>Distance between layers</source>
        <translation>Distance entre les couches</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Distance between neighbouring beads of a layer.</source>
        <translation>Distance entre cordons voisins d&apos;une couche.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>Distance between neighbouring layers.</source>
        <translation>Distance entre couches voisines.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/plots/process.py"/>
        <source>Distance to the layer before (asked: {0} mm)</source>
        <translation>Distance à la couche précédente (demandée : {0} mm)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Distortion</source>
        <translation>Distorsion</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>Divides the translation rows of the Jacobian.</source>
        <translation>Divise les lignes de translation du jacobien.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/saving.py"/>
        <source>Document (*.pdf)</source>
        <translation>Document (*.pdf)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/feature_order.py"/>
        <source>Down</source>
        <translation>Descendre</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/form.py"/>
        <source>Draw beads as lines, or as tubes of their width and layer height</source>
        <translation>Dessiner les cordons en lignes, ou en tubes de leur largeur et hauteur de couche</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/saving.py"/>
        <source>Drawing (*.svg)</source>
        <translation>Dessin (*.svg)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/canvas.py"/>
        <source>Drawing…</source>
        <translation>Dessin en cours…</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/stage.py"/>
        <source>Driven by the expression {}</source>
        <translation>Mené par l&apos;expression {}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>Dry run</source>
        <translation>Marche à vide</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/fanuc/post.py"/>
        <source>E1 of the robot&apos;s own motion group</source>
        <translation>E1 du groupe de mouvement du robot lui-même</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/simulation/bars.py"/>
        <source>Each joint in its range, how far it is from the nearer limit, and the share of its largest speed that is asked of it</source>
        <translation>Chaque articulation dans sa plage, sa distance à la limite la plus proche, et la part de sa plus grande vitesse qui lui est demandée</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/table.py"/>
        <source>Eccentricity at {0} mm</source>
        <translation>Excentricité à {0} mm</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/surface_feature.py"/>
        <source>Edges of the wall in which layers start, in place of where it leaves the substrate.</source>
        <translation>Arêtes de la paroi où commencent les couches, au lieu de là où elle quitte le substrat.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/mesh_wall.py"/>
        <source>Edge{0} at {1}</source>
        <translation>Edge{0} en {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/context_menu.py"/>
        <source>Edit parameters…</source>
        <translation>Modifier les paramètres…</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/context_menu.py"/>
        <source>Edit…</source>
        <translation>Modifier…</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>End</source>
        <translation>Fin</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/background/busy.py"/>
        <source>Ends the computation; the document stays as it was before</source>
        <translation>Arrête le calcul ; le document reste tel qu&apos;il était avant</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/placement/form.py"/>
        <source>Enter the pose that is chosen in the table into the cell</source>
        <translation>Entrer dans la cellule la pose choisie dans le tableau</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/figures.py"/>
        <source>Eq. 17</source>
        <translation>Éq. 17</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/checks.py"/>
        <source>Every axis stays within its limits</source>
        <translation>Chaque axe reste dans ses limites</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/deposit.py"/>
        <source>Every bead is carried by what lies below it</source>
        <translation>Chaque cordon est porté par ce qui est dessous</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Export Path…</source>
        <translation>Exporter la trajectoire…</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/context_menu.py"/>
        <source>Export files…</source>
        <translation>Exporter les fichiers…</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/export_path.py"/>
        <source>Export path</source>
        <translation>Exporter la trajectoire</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/context_menu.py"/>
        <source>Export path…</source>
        <translation>Exporter la trajectoire…</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/program/window.py"/>
        <source>Export program</source>
        <translation>Exporter le programme</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/context_menu.py"/>
        <source>Export report…</source>
        <translation>Exporter le rapport…</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/program/window.py"/>
        <source>Export…</source>
        <translation>Exporter…</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>External</source>
        <translation>Externes</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>External axes</source>
        <translation>Axes externes</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>External axes. level: they turn no more than the angle from the vertical asks for; optimised: one polynomial per bead of each, together with the rotation about the tool, for less motion and larger margins.</source>
        <translation>Axes externes. level : ils ne tournent pas plus que l&apos;angle à la verticale ne le demande ; optimised : un polynôme par cordon pour chacun, avec la rotation autour de l&apos;outil, pour moins de mouvement et de plus grandes marges.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/cladding.py"/>
        <source>Faces</source>
        <translation>Faces</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/curves.py"/>
        <source>Faces of the same object that the curves lie on, whose normals are the directions; none: the table&apos;s own, or the direction below.</source>
        <translation>Faces du même objet sur lesquelles reposent les courbes, dont les normales sont les directions ; aucune : celles du tableau, ou la direction ci-dessous.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/feature.py"/>
        <source>Faces of the wall, from the platform up.</source>
        <translation>Faces de la paroi, du plateau vers le haut.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/surface_feature.py"/>
        <source>Faces of the wall.</source>
        <translation>Faces de la paroi.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/cladding_feature.py"/>
        <source>Faces that are covered.</source>
        <translation>Faces qui sont recouvertes.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/solid.py"/>
        <source>Faces that lean out over nothing by more than this angle are red in the 3D view</source>
        <translation>Les faces qui surplombent le vide de plus que cet angle sont rouges dans la vue 3D</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Fastest</source>
        <translation>Le plus rapide</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Fastest travel speed at which the material is laid; faster beads are reported.</source>
        <translation>Vitesse d&apos;avance la plus rapide à laquelle le matériau est déposé ; les cordons plus rapides sont signalés.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/revolution.py"/>
        <source>Feature</source>
        <translation>Élément</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Feature…</source>
        <translation>Élément…</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Feed</source>
        <translation>Dévidage</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Feed mode</source>
        <translation>Mode de dévidage</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>Feed of joint moves: the time of each (G93), or the speed of the linear axes wherever they move (G94).</source>
        <translation>Avance des mouvements articulaires : le temps de chacun (G93), ou la vitesse des axes linéaires partout où ils bougent (G94).</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>Fewest points of a full turn, however small its radius.</source>
        <translation>Nombre minimal de points d&apos;un tour entier, si petit que soit son rayon.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/source_page.py"/>
        <source>Figures of an arm with a spherical wrist (OPW)</source>
        <translation>Cotes d&apos;un bras à poignet sphérique (OPW)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/inspection/inputs.py"/>
        <source>File</source>
        <translation>Fichier</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/program/window.py"/>
        <source>Files written to {}: {}</source>
        <translation>Fichiers écrits dans {} : {}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/inspection/panel.py"/>
        <source>Files written: {}</source>
        <translation>Fichiers écrits : {}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Fill</source>
        <translation>Remplissage</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Fill angle</source>
        <translation>Angle de remplissage</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Fill angle step</source>
        <translation>Pas de l&apos;angle de remplissage</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Fill density</source>
        <translation>Densité de remplissage</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Fill width</source>
        <translation>Largeur de remplissage</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>First</source>
        <translation>Premier</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>First bead of that layer.</source>
        <translation>Premier cordon de cette couche.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/tool.py"/>
        <source>First close the task panel that is open.</source>
        <translation>Fermez d&apos;abord le panneau de tâche ouvert.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>First layer to deposit.</source>
        <translation>Première couche à déposer.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/wall.py"/>
        <source>First layer: {}</source>
        <translation>Première couche : {}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/needs.py"/>
        <source>First make a cell: Cell….</source>
        <translation>Faites d&apos;abord une cellule : Cellule….</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/needs.py"/>
        <source>First make a feature: Feature…, Wall on Part…, Solid… and Solids on Hub… do so.</source>
        <translation>Faites d&apos;abord un élément : Élément…, Paroi sur pièce…, Solide… et Solides sur moyeu… le font.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/needs.py"/>
        <source>First make a joint path: Joint Path…, or all stages at once: New Job….</source>
        <translation>Faites d&apos;abord une trajectoire articulaire : Trajectoire articulaire…, ou toutes les étapes à la fois : Nouveau travail….</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/needs.py"/>
        <source>First make a toolpath: Toolpath….</source>
        <translation>Faites d&apos;abord une trajectoire d&apos;outil : Trajectoire d&apos;outil….</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/needs.py"/>
        <source>First open a part with faces, such as a STEP file; a mesh has none.</source>
        <translation>Ouvrez d&apos;abord une pièce à faces, comme un fichier STEP ; un maillage n&apos;en a pas.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/needs.py"/>
        <source>First open a part, or import one into this document.</source>
        <translation>Ouvrez d&apos;abord une pièce, ou importez-en une dans ce document.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/needs.py"/>
        <source>First open a part, or make a document.</source>
        <translation>Ouvrez d&apos;abord une pièce, ou créez un document.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/inspection.py"/>
        <source>Fit</source>
        <translation>Ajustement</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>Fit of the bead widths</source>
        <translation>Ajustement des largeurs de cordon</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/cladding.py"/>
        <source>Fixtures</source>
        <translation>Montages</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/frames_page.py"/>
        <source>Flange</source>
        <translation>Bride</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/preferences/page.py"/>
        <source>Folders</source>
        <translation>Dossiers</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/hub.py"/>
        <source>For walls only: solids on a hub grow along the normals of its surface</source>
        <translation>Des parois seulement : les solides sur moyeu croissent le long des normales de sa surface</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>Four axes only: by how much the tool may miss the direction asked for.</source>
        <translation>Quatre axes seulement : de combien l&apos;outil peut manquer la direction demandée.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/frames_page.py"/>
        <source>Frames (mm, deg): the maker&apos;s base on the floor, the flange in the last link</source>
        <translation>Repères (mm, deg) : la base du constructeur sur le sol, la bride dans le dernier corps</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/frames_page.py"/>
        <source>Frames and conventions</source>
        <translation>Repères et conventions</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Free Rotation Map…</source>
        <translation>Carte de la rotation libre…</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/dock.py"/>
        <source>Free rotation of {title}</source>
        <translation>Rotation libre de {title}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/interop/export.py"/>
        <source>FreeCAD wrote no STEP file; see the report view, or write DXF instead</source>
        <translation>FreeCAD n&apos;a pas écrit de fichier STEP ; voyez la vue rapport, ou écrivez DXF</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/frames_page.py"/>
        <source>From</source>
        <translation>De</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/form.py"/>
        <source>From layer</source>
        <translation>De la couche</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/source_page.py"/>
        <source>From link</source>
        <translation>Du corps</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>From the base circle to the apex of the cone, along the axis; inf: a cylinder.</source>
        <translation>Du cercle de base au sommet du cône, le long de l&apos;axe ; inf : un cylindre.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>From the flange, or the face of a rotary table, to the mounting plane along its Z, or a pose on it.</source>
        <translation>De la bride, ou de la face d&apos;un axe rotatif, au plan de montage le long de son Z, ou une pose sur elle.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/form.py"/>
        <source>From where to where each joint goes on this curve; red past a limit</source>
        <translation>D&apos;où à où va chaque articulation sur cette courbe ; rouge au-delà d&apos;une limite</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/developable_feature.py"/>
        <source>Further</source>
        <translation>Autres</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/toolpath.py"/>
        <source>Further features, deposited after it in this order.</source>
        <translation>Autres éléments, déposés après lui dans cet ordre.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>Further methods planned for the comparison of the report.</source>
        <translation>Autres méthodes planifiées pour la comparaison du rapport.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/cladding.py"/>
        <source>Further part</source>
        <translation>Pièce supplémentaire</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/developable_feature.py"/>
        <source>Further solids or closed meshes to deposit on the same hub.</source>
        <translation>Autres solides ou maillages fermés à déposer sur le même moyeu.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/solid_feature.py"/>
        <source>Further solids or closed meshes to deposit.</source>
        <translation>Autres solides ou maillages fermés à déposer.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>Further spacings whose joint paths are planned for the comparison of the report.</source>
        <translation>Autres espacements dont les trajectoires articulaires sont planifiées pour la comparaison du rapport.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Fuse</source>
        <translation>Fusionner</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Gain</source>
        <translation>Gain</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Gap</source>
        <translation>Jour</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Gas</source>
        <translation>Gaz</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/preferences/page.py"/>
        <source>General</source>
        <translation>Général</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/checks/predicted_shape.py"/>
        <source>Give strategy.margin {0} mm more than it has, or wider beads</source>
        <translation>Donnez à strategy.margin {0} mm de plus, ou des cordons plus larges</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>Given polynomials</source>
        <translation>Polynômes donnés</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/context_menu.py"/>
        <source>Go to {}</source>
        <translation>Aller à {}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>Group output, H word, register or analogue output that carries it; for KUKA the first of eight outputs.</source>
        <translation>Sortie de groupe, mot H, registre ou sortie analogique qui le transmet ; chez KUKA la première de huit sorties.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/new_job/panel.py"/>
        <source>Grows on</source>
        <translation>Croît sur</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/solid.py"/>
        <source>Guide</source>
        <translation>Guide</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/siemens/post.py"/>
        <source>H words have address extensions to {0}, not {1}; use another output, or program.nc.deposit_on and deposit_off</source>
        <translation>les mots H ont des extensions d&apos;adresse jusqu&apos;à {0}, et non {1} ; utilisez une autre sortie, ou program.nc.deposit_on et deposit_off</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/export_path.py"/>
        <source>HTML page of the report</source>
        <translation>Page HTML du rapport</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>Half angle</source>
        <translation>Demi-angle</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/fit_plot.py"/>
        <source>Height</source>
        <translation>Hauteur</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/solid_feature.py"/>
        <source>Height along the stacking direction.</source>
        <translation>Hauteur suivant la direction d&apos;empilement.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/inspection.py"/>
        <source>Heights</source>
        <translation>Hauteurs</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/inspection.py"/>
        <source>Heights above the part&apos;s base, in mm, at which circularity is evaluated; none: a sixth, a half and five sixths of what was measured.</source>
        <translation>Hauteurs au-dessus de la base de la pièce, en mm, auxquelles la circularité est dite ; aucune : un sixième, la moitié et cinq sixièmes de ce qui a été mesuré.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/whats_this.py"/>
        <source>Help on Robotic AM</source>
        <translation>Aide de Robotic AM</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/views/cell.py"/>
        <source>Hide machine</source>
        <translation>Cacher la machine</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>Holes of meshes up to this size across are closed, with a note; larger ones are refused.</source>
        <translation>Les trous des maillages jusqu&apos;à cette largeur sont fermés, ce qui est signalé ; les plus grands sont refusés.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>How far a closed bead runs on past its seam.</source>
        <translation>De combien un cordon fermé continue au-delà de sa couture.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>How far a touched point may be from where the others say that it is.</source>
        <translation>De combien un point palpé peut s&apos;écarter d&apos;où les autres le situent.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/place.py"/>
        <source>How far its RX is changed to either side.</source>
        <translation>De combien son RX est changé de chaque côté.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/place.py"/>
        <source>How far its RY is changed to either side.</source>
        <translation>De combien son RY est changé de chaque côté.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/place.py"/>
        <source>How far its RZ is changed to either side.</source>
        <translation>De combien son RZ est changé de chaque côté.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/place.py"/>
        <source>How far its x is changed to either side.</source>
        <translation>De combien son x est changé de chaque côté.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/place.py"/>
        <source>How far its y is changed to either side.</source>
        <translation>De combien son y est changé de chaque côté.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/place.py"/>
        <source>How far its z is changed to either side.</source>
        <translation>De combien son z est changé de chaque côté.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>How far the deposit is to reach beyond the part everywhere, to be machined off: its shape is predicted and compared with the part; none: it is not.</source>
        <translation>De combien le dépôt doit dépasser la pièce partout, pour être usiné : sa forme est prédite et comparée à la pièce ; rien : elle ne l&apos;est pas.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>How far the deposit stands out from the part, to be machined off; above it by the layers that begin less than that above its last one.</source>
        <translation>De combien le dépôt dépasse sur les côtés de la pièce, à usiner ; au-dessus, des couches qui commencent moins haut que cela au-dessus de sa dernière.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>How far the direction of lines and zigzags turns from layer to layer.</source>
        <translation>De combien la direction des lignes et des zigzags tourne d&apos;une couche à l&apos;autre.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/scan.py"/>
        <source>How far the height of layers may differ from the layer height where they lead from what was scanned back to the plan.</source>
        <translation>Écart permis entre la hauteur des couches et la hauteur de couche là où elles ramènent de ce qui a été numérisé au plan.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/scan.py"/>
        <source>How far the scan may lie from what was planned; farther, and it is taken for a scan of something else.</source>
        <translation>Distance permise entre la numérisation et ce qui était prévu ; au-delà, elle passe pour la numérisation d&apos;autre chose.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>How far the start moves from layer to layer.</source>
        <translation>De combien le départ se déplace d&apos;une couche à l&apos;autre.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>How far the tool is withdrawn along its axis between beads.</source>
        <translation>De combien l&apos;outil est retiré le long de son axe entre les cordons.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>How far the torch goes back over an open bead from its end, still depositing, so that its crater is filled.</source>
        <translation>Distance sur laquelle la torche revient sur un cordon ouvert depuis sa fin, en déposant toujours, afin de remplir son cratère.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>How layers are found: on a tube of one surface by its closed parameter and on all other walls as fronts (auto), or as fronts on every wall (fronts).</source>
        <translation>Comment les couches sont trouvées : sur un tube d&apos;une seule surface par son paramètre fermé, sur toute autre paroi par des fronts (auto), ou par des fronts sur toutes les parois (fronts).</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>How long to wait between layers.</source>
        <translation>Temps d&apos;attente entre les couches.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>How many contours lie round lines and the like; inf: contours only.</source>
        <translation>Nombre de contours autour des lignes et autres motifs ; inf : contours seuls.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>How many layers lie on the faces, one layer height over the other along their normals.</source>
        <translation>Nombre de couches sur les faces, l&apos;une à une hauteur de couche au-dessus de l&apos;autre, le long de leurs normales.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/inspection/panel.py"/>
        <source>How many points have what deviation; dashed: the tolerance</source>
        <translation>Combien de points ont quel écart ; tirets : la tolérance</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/simulation/fields.py"/>
        <source>How many seconds of the job pass in one</source>
        <translation>Combien de secondes du travail passent en une</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>How many times the curves are laid, one layer height over the other.</source>
        <translation>Combien de fois les courbes sont déposées, l&apos;une à une hauteur de couche au-dessus de l&apos;autre.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>How much corners within a bead are rounded, percent: CNT of FANUC, and of the most that others may.</source>
        <translation>Arrondi des coins dans un cordon, en pour cent : CNT de FANUC, et du plus grand permis pour les autres.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>How much of the bead it is.</source>
        <translation>Quelle longueur du cordon c&apos;est.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>How narrow and how wide beads may be, of their usual width and spacing, so that contours come out even over the thickness of a region, and beads in thin places are as wide as these.</source>
        <translation>Largeurs extrêmes que les cordons peuvent avoir, en part de leur largeur et de leur écartement habituels, pour que les contours se répartissent également sur l&apos;épaisseur d&apos;une région et que les cordons aient la largeur des endroits minces.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>How narrow, of their usual width, beads in planes may be laid where others leave them less room; all of it: none is, and layers get higher there.</source>
        <translation>À quelle part de leur largeur habituelle les cordons en couches planes peuvent se réduire là où d&apos;autres leur laissent moins de place ; toute la largeur : aucun ne se réduit, et les couches y deviennent plus hautes.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/new_job/panel.py"/>
        <source>How the part is cut into layers; proposed from the selection</source>
        <translation>Comment la pièce est découpée en couches ; proposé d&apos;après la sélection</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/inspection.py"/>
        <source>How the points may be moved onto the part: best fit, shifts only, a turn about and a shift along the part&apos;s axis, or none but what pairs of points say.</source>
        <translation>Comment les points peuvent être ramenés sur la pièce : meilleur ajustement, translations seules, rotation autour de l&apos;axe de la pièce et translation le long de celui-ci, ou rien que ce que disent les paires de points.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>How wide the beads of solids on hubs count in filling: as the spacing, or as the bead width; auto: as the bead width where it is given, held by a bead model, or an overlap counts with it.</source>
        <translation>Largeur pour laquelle comptent au remplissage les cordons de solides sur moyeu : la distance des cordons, ou la largeur de cordon ; auto : la largeur de cordon si elle est donnée, tenue par un modèle de cordon, ou si un recouvrement compte avec elle.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/hub.py"/>
        <source>Hub</source>
        <translation>Moyeu</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/siemens/post.py"/>
        <source>H{0} switches the deposit; use another one for schedules</source>
        <translation>H{0} commute le dépôt ; prenez-en un autre pour les programmes de soudage</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/saving.py"/>
        <source>Image (*.png)</source>
        <translation>Image (*.png)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/fields.py"/>
        <source>In a job file: {}; in macros: {}.</source>
        <translation>Dans un fichier de travail : {} ; dans les macros : {}.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/new_job/after.py"/>
        <source>In plane layers, for curved ones could not be carried out. {}</source>
        <translation>En couches planes, car des couches courbes n’étaient pas réalisables. {}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/table.py"/>
        <source>In tolerance</source>
        <translation>Dans la tolérance</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Input</source>
        <translation>Entrée</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/new_job/panel.py"/>
        <source>Inputs</source>
        <translation>Entrées</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/inspection/panel.py"/>
        <source>Inspect</source>
        <translation>Contrôler</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/toolpath.py"/>
        <source>Inspection</source>
        <translation>Contrôle</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Inspect…</source>
        <translation>Contrôler…</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/fields.py"/>
        <source>It may follow an expression: {}.</source>
        <translation>Peut suivre une expression : {}.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>It stands at</source>
        <translation>Il est arrêté à</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>Iterations after which the optimiser gives up on a layer.</source>
        <translation>Nombre d&apos;itérations après lequel l&apos;optimiseur renonce à une couche.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/name_page.py"/>
        <source>Its controller reads</source>
        <translation>Sa commande lit</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/frames_page.py"/>
        <source>Its limits as the data sheet has them; leave them empty where there are none. Those of the page before are against link 2.</source>
        <translation>Ses limites telles que la fiche technique les donne ; laissez vide là où il n&apos;y en a pas. Celles de la page précédente sont par rapport au corps 2.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/frames_page.py"/>
        <source>J3 as shown</source>
        <translation>J3 tel que montré</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/limits_page.py"/>
        <source>Jerk</source>
        <translation>Jerk</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/poses_page.py"/>
        <source>Jog the machine to at least three poses in which every axis has moved, and type what the pendant shows: the joints, and the place of the tool frame in the base frame. The maker&apos;s simulator does as well; figures that were computed from this geometry prove nothing. A table can be pasted.</source>
        <translation>Amenez la machine à au moins trois poses où chaque axe a bougé, et saisissez ce que montre le pupitre : les articulations, et la place du repère outil dans le repère de base. Le simulateur du constructeur convient aussi ; des chiffres calculés à partir de cette géométrie ne prouvent rien. Un tableau peut être collé.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Joint Path…</source>
        <translation>Trajectoire articulaire…</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>Joint accelerations</source>
        <translation>Accélérations articulaires</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>Joint angles</source>
        <translation>Angles articulaires</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>Joint jerks</source>
        <translation>Jerks articulaires</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/joint_path.py"/>
        <source>Joint path</source>
        <translation>Trajectoire articulaire</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/ur/post.py"/>
        <source>Joint programs rely on the nominal arm; the calibrated one stands up to millimetres off it</source>
        <translation>Les programmes articulaires comptent sur le bras nominal ; le bras étalonné s&apos;en écarte jusqu&apos;à quelques millimètres</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>Joint speeds</source>
        <translation>Vitesses articulaires</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>Joint speeds in %</source>
        <translation>Vitesses articulaires en %</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/kuka/post.py"/>
        <source>Joint speeds of the machine file are those the controller calls 100 %</source>
        <translation>Les vitesses articulaires du fichier de machine sont celles que la commande appelle 100 %</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>Joint speeds while depositing</source>
        <translation>Vitesses articulaires pendant le dépôt</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/fanuc/post.py"/>
        <source>Joint values mean what the machine file says, J3 above all</source>
        <translation>Les valeurs articulaires ont le sens que dit le fichier machine, J3 surtout</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/joint_path.py"/>
        <source>Joints</source>
        <translation>Articulations</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/new_job/panel.py"/>
        <source>Kind</source>
        <translation>Type</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Largest angle between the stacking direction and a wall that leans out, before there is a warning; 90 deg: none.</source>
        <translation>Plus grand angle entre la direction d&apos;empilement et une paroi en surplomb, avant un avertissement ; 90 deg : aucun.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/build_direction.py"/>
        <source>Largest angle between the tool axis and the vertical of the part.</source>
        <translation>Plus grand angle entre l&apos;axe de l&apos;outil et la verticale de la pièce.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Largest change of the travel speed along a bead, in mm/s per second, where a bead model sets it.</source>
        <translation>Plus grande variation de la vitesse d&apos;avance le long d&apos;un cordon, en mm/s par seconde, là où un modèle de cordon la règle.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/table.py"/>
        <source>Largest deviation inside</source>
        <translation>Plus grand écart vers l&apos;intérieur</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/table.py"/>
        <source>Largest deviation outside</source>
        <translation>Plus grand écart vers l&apos;extérieur</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/inspection.py"/>
        <source>Largest deviation.</source>
        <translation>Plus grand écart.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>Largest direction error</source>
        <translation>Écart de direction maximal</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>Largest distance between a bead and the straight segments that stand for it.</source>
        <translation>Plus grande distance entre un cordon et les segments droits qui le représentent.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>Largest error of the local distance of constant-distance layers.</source>
        <translation>Plus grande erreur de la distance locale des couches constant-distance.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/joint_path.py"/>
        <source>Largest joint speed: {:.0f} % of what {} can do, in layer {}</source>
        <translation>Vitesse articulaire la plus grande : {:.0f} % de ce que peut {}, couche {}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Largest share by which beads may lie nearer together or farther apart than the bead spacing on faces that are bent both ways; these are covered in pieces that keep to it.</source>
        <translation>Plus grande part dont les cordons peuvent être plus serrés ou plus espacés que l&apos;espacement des cordons sur des faces courbées dans les deux sens ; elles sont couvertes par morceaux qui s&apos;y tiennent.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/table.py"/>
        <source>Largest thickness</source>
        <translation>Plus grande épaisseur</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/build_direction.py"/>
        <source>Largest turn of build direction and tool axis along a bead, on walls on an existing part, on hubs and in curved layers; where they would turn faster, at corners, they are spread out, and the deviation is reported.</source>
        <translation>Plus grande rotation de la direction de dépôt et de l&apos;axe de l&apos;outil le long d&apos;un cordon, sur les parois d&apos;une pièce existante, sur les moyeux et dans les couches courbes ; là où ils tourneraient plus vite, aux angles, ils sont étalés, et leur écart est dit.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>Last layers trimmed flush with the wall&apos;s upper edge, or whole layers only.</source>
        <translation>Dernières couches coupées au ras du bord supérieur de la paroi, ou couches entières seulement.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/shape/compare.py"/>
        <source>Lay layers as high as they come out first</source>
        <translation>Déposez d&apos;abord les couches à la hauteur qu&apos;elles ont réellement</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/checks/predicted_shape.py"/>
        <source>Lay one more layer, or leave less of it to machine</source>
        <translation>Déposez une couche de plus, ou laissez moins à usiner</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/controls.py"/>
        <source>Layer</source>
        <translation>Couche</translation>
    </message>
    <message>
        <location filename="../../freecad_am/plots/deviation.py"/>
        <source>Layer by layer</source>
        <translation>Couche par couche</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>Layer height</source>
        <translation>Hauteur de couche</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/simulation/wording.py"/>
        <source>Layer {layer} ({first} to {last}), bead {bead}, point {point}</source>
        <translation>Couche {layer} ({first} à {last}), cordon {bead}, point {point}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/facts.py"/>
        <source>Layer {} (0 to {})</source>
        <translation>Couche {} (0 à {})</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/readout.py"/>
        <source>Layer {} bead {} point {}</source>
        <translation>Couche {} cordon {} point {}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/feature.py"/>
        <source>Layers</source>
        <translation>Couches</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>Layers at the layer height from the nearest point of the one below (constant-distance), within a band of it and without corners (smooth), or along the lines up the wall (iso-parameter).</source>
        <translation>Couches à la hauteur de couche du point le plus proche de celle du dessous (constant-distance), dans une bande autour d&apos;elle et sans angles (smooth), ou le long des lignes qui montent la paroi (iso-parameter).</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/deposit.py"/>
        <source>Layers come out as high as they are planned</source>
        <translation>Les couches ont la hauteur prévue</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>Layers equally spaced along the wall (arc-length) or along the axis (iso-height).</source>
        <translation>Couches également espacées le long de la paroi (arc-length) ou le long de l&apos;axe (iso-height).</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/deposit.py"/>
        <source>Layers lie one layer height apart</source>
        <translation>Les couches sont distantes d’une hauteur de couche</translation>
    </message>
    <message>
        <location filename="../../InitGui.py"/>
        <source>Layers, joint paths and checked programs for robots that deposit material</source>
        <translation>Couches, trajectoires articulaires et programmes vérifiés pour les robots qui déposent de la matière</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/revolution.py"/>
        <source>Layers: {}, along {:.4g} mm of wall</source>
        <translation>Couches : {}, le long de {:.4g} mm de paroi</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/build_direction.py"/>
        <source>Lead</source>
        <translation>Angle d&apos;avance</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Lead off</source>
        <translation>Retard à l&apos;arrêt</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Lead on</source>
        <translation>Avance au départ</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/joint_path.py"/>
        <source>Lead times and waits between layers (s).</source>
        <translation>Temps d&apos;avance et de retard et attentes entre les couches (s).</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/table.py"/>
        <source>Least</source>
        <translation>Minimum</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>Least condition</source>
        <translation>Condition minimale</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/joint_path.py"/>
        <source>Least condition: {0:.3f}, in layer {2}</source>
        <translation>Condition la plus faible : {0:.3f}, couche {2}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/inspection.py"/>
        <source>Least deviation.</source>
        <translation>Plus petit écart.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/joint_path.py"/>
        <source>Least joint margin: {:.1f} %, of {} in layer {}</source>
        <translation>Marge articulaire la plus faible : {:.1f} %, de {}, couche {}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/placement/figures.py"/>
        <source>Least margin, %</source>
        <translation>Plus petite marge, %</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/table.py"/>
        <source>Least thickness</source>
        <translation>Plus petite épaisseur</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Least time between the end of a solid&apos;s layer and the start of its next.</source>
        <translation>Temps minimal entre la fin de la couche d&apos;un solide et le début de la suivante.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Least time of a layer, from its first bead to the next layer&apos;s; the machine waits for what is missing, and islands come in the same order in every layer, so that each cools while the others are laid.</source>
        <translation>Durée minimale d&apos;une couche, de son premier cordon à celui de la suivante ; la machine attend ce qui manque, et les îlots viennent dans le même ordre à chaque couche, afin que chacun refroidisse pendant le dépôt des autres.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>Least time of a layer, from its first bead to the next layer&apos;s; the machine waits for what is missing.</source>
        <translation>Durée minimale d&apos;une couche, de son premier cordon à celui de la suivante ; la machine attend ce qui manque.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/cell/proposing.py"/>
        <source>Left as it was entered; for {} it would be {}.</source>
        <translation>Laissé comme saisi ; pour {} ce serait {}.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/cell/proposing.py"/>
        <source>Left as it was entered; the job of {} can be done with {}.</source>
        <translation>Laissé comme saisi ; la tâche de {} peut se faire avec {}.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>Length</source>
        <translation>Longueur</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/source_page.py"/>
        <source>Length along x, mm</source>
        <translation>Longueur le long de x, mm</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Length beside it along which the speed changes step by step to that of the bead.</source>
        <translation>Longueur à côté, le long de laquelle la vitesse passe par paliers à celle du cordon.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/toolpath.py"/>
        <source>Length of all beads.</source>
        <translation>Longueur de tous les cordons.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/joint_path.py"/>
        <source>Length of the deposit as it is run.</source>
        <translation>Longueur du dépôt tel que parcouru.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/feature.py"/>
        <source>Length of the meridian.</source>
        <translation>Longueur du méridien.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>Length of the nozzle from its tip.</source>
        <translation>Longueur de la buse à partir de son bout.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/source_page.py"/>
        <source>Lengths are in mm, angles in degrees. Robots need six axes that turn, machine tools three axes that slide and two that turn; whether yours is one is checked when you go on. Tracks, turntables and positioners, which stand beside a robot, have one axis or two.</source>
        <translation>Les longueurs sont en mm, les angles en degrés. Les robots ont besoin de six axes qui tournent, les machines-outils de trois axes qui glissent et deux qui tournent ; si la vôtre en est une est examiné à la page suivante. Les rails, tables tournantes et positionneurs, qui se trouvent à côté d&apos;un robot, ont un axe ou deux.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/quantity.py"/>
        <source>Let it follow an expression, such as {}Spreadsheet.height / 2</source>
        <translation>Le faire suivre une expression, comme {}Spreadsheet.height / 2</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/form.py"/>
        <source>Let the planner choose</source>
        <translation>Laisser choisir</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Lift</source>
        <translation>Dégagement vertical</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>Limits</source>
        <translation>Limites</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/limits_page.py"/>
        <source>Limits, speeds, accelerations and jerks</source>
        <translation>Limites, vitesses, accélérations et jerks</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/program/window.py"/>
        <source>Line {}: {}</source>
        <translation>Ligne {} : {}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>LinuxCNC: M428 and M429 choose between tip and axes; false for a machine with axes only.</source>
        <translation>LinuxCNC : M428 et M429 choisissent entre bout d&apos;outil et axes ; faux pour une machine qui n&apos;a que ses axes.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>LinuxCNC: how far corners may be rounded (G64 P).</source>
        <translation>LinuxCNC : de combien les angles peuvent être arrondis (G64 P).</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/deposit.py"/>
        <source>Little is deposited twice</source>
        <translation>Peu de matière est déposée deux fois</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/staubli/post.py"/>
        <source>Loaded parts and tools that stand on other tools have been tried with a dry run</source>
        <translation>Le chargement des parties et les outils portés par d’autres outils ont été essayés à vide</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/simulation/wording.py"/>
        <source>Longer by</source>
        <translation>Plus long de</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Longest link</source>
        <translation>Liaison maximale</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Longest way from one line of a zigzag to the next, as a share of the bead spacing; where it would be longer another zigzag begins.</source>
        <translation>Plus long chemin d&apos;une ligne d&apos;un zigzag à la suivante, en part de la distance des cordons ; là où il serait plus long un autre zigzag commence.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/form.py"/>
        <source>Look</source>
        <translation>Aspect</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/new_job/panel.py"/>
        <source>Looking at the shape.</source>
        <translation>Examen de la forme.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/preferences/page.py"/>
        <source>Looks</source>
        <translation>Aspect</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/figures.py"/>
        <source>Lost</source>
        <translation>Perdus</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>M or H word that switches the deposit off.</source>
        <translation>Mot M ou H qui coupe le dépôt.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>M or H word that switches the deposit on, such as M7 or H2=1; without one the digital output does.</source>
        <translation>Mot M ou H qui met le dépôt en marche, comme M7 ou H2=1 ; sans lui la sortie logique le fait.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/linuxcnc/post.py"/>
        <source>M428 and M429 switch the kinematics, and the work offset is that of the remarks</source>
        <translation>M428 et M429 commutent la cinématique, et l’origine pièce est celle des remarques</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/source_page.py"/>
        <source>Machine</source>
        <translation>Machine</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/preferences/page.py"/>
        <source>Machine files</source>
        <translation>Fichiers machine</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/wizard.py"/>
        <source>Machine {} is written: {}</source>
        <translation>La machine {} est écrite : {}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Machining allowance</source>
        <translation>Surépaisseur d&apos;usinage</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/dock.py"/>
        <source>Made from an earlier state; recompute the document.</source>
        <translation>Fait à partir d&apos;un état antérieur ; recalculez le document.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/export_path.py"/>
        <source>Make</source>
        <translation>Faire</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/form.py"/>
        <source>Make the curve that of the joint path, and plan it again</source>
        <translation>Faire de la courbe celle de la trajectoire articulaire, et la replanifier</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/name_page.py"/>
        <source>Maker and model</source>
        <translation>Constructeur et modèle</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/cell.py"/>
        <source>Maker and model of the machine.</source>
        <translation>Constructeur et modèle de la machine.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Makes a machine file from a URDF, a Denavit-Hartenberg table or OPW figures, checked against poses</source>
        <translation>Fait un fichier machine d&apos;un URDF, d&apos;un tableau de Denavit-Hartenberg ou de cotes OPW, vérifié par des poses</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Makes all stages for the selected shape, from cell to program</source>
        <translation>Fait toutes les étapes pour la forme sélectionnée, de la cellule au programme</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/context_menu.py"/>
        <source>Map of the free rotation…</source>
        <translation>Carte de la rotation libre…</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/figures.py"/>
        <source>Margin</source>
        <translation>Marge</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/simulation/wording.py"/>
        <source>Mass</source>
        <translation>Masse</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/joint_path.py"/>
        <source>Mass of the deposit (g).</source>
        <translation>Masse du dépôt (g).</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Material</source>
        <translation>Matériau</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/build_direction.py"/>
        <source>Max from vertical</source>
        <translation>Écart max à la verticale</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>Max iterations</source>
        <translation>Itérations max</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Max overhang</source>
        <translation>Surplomb max.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>Max points</source>
        <translation>Points max</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/build_direction.py"/>
        <source>Max tilt</source>
        <translation>Inclinaison max</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/build_direction.py"/>
        <source>Max turn</source>
        <translation>Rotation max</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/table.py"/>
        <source>Mean</source>
        <translation>Moyenne</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/table.py"/>
        <source>Mean deviation</source>
        <translation>Écart moyen</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/inspection.py"/>
        <source>Mean deviation, outside with a plus.</source>
        <translation>Écart moyen, vers l&apos;extérieur avec un plus.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/table.py"/>
        <source>Mean thickness</source>
        <translation>Épaisseur moyenne</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/inspection/inputs.py"/>
        <source>Measured points</source>
        <translation>Points mesurés</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>Mend</source>
        <translation>Réparer</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>Method</source>
        <translation>Méthode</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>Method constant: the one RZ, or auto to search it.</source>
        <translation>Méthode constant : le RZ unique, ou auto pour le chercher.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>Method layer-by-layer: polynomials that are given, not searched: layer/bead:constant:slope, or * for every other bead, in deg and deg per turn.</source>
        <translation>Méthode layer-by-layer : polynômes donnés, non cherchés : couche/cordon:constante:pente, ou * pour tout autre cordon, en deg et deg par tour.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Middle x y z of the base circle and direction i j k of the axis, towards the apex, in the part&apos;s coordinates.</source>
        <translation>Centre x y z du cercle de base et direction i j k de l&apos;axe, vers le sommet, dans les coordonnées de la pièce.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>Min layer time</source>
        <translation>Durée minimale de couche</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>Min points</source>
        <translation>Points min</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/build_direction.py"/>
        <source>Mode</source>
        <translation>Mode</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/source_page.py"/>
        <source>Modified (Craig): Rot(x, alpha) Trans(x, a) Rot(z, theta) Trans(z, d)</source>
        <translation>Modifié (Craig) : Rot(x, alpha) Trans(x, a) Rot(z, theta) Trans(z, d)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/placement/form.py"/>
        <source>More</source>
        <translation>Plus</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/table.py"/>
        <source>Most</source>
        <translation>Maximum</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>Most points of one program file; longer ones are chained.</source>
        <translation>Nombre maximal de points d&apos;un fichier de programme ; les plus longs sont enchaînés.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>Motion</source>
        <translation>Mouvement</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>Mount</source>
        <translation>Montage</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/place.py"/>
        <source>Moves</source>
        <translation>Déplace</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>NC machines</source>
        <translation>Machines à CN</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/new_job/panel.py"/>
        <source>Name</source>
        <translation>Nom</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/name_page.py"/>
        <source>Name and posts</source>
        <translation>Nom et post-processeurs</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/name_page.py"/>
        <source>Name in jobs</source>
        <translation>Nom dans les travaux</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Name of the material; carried to the report.</source>
        <translation>Nom du matériau ; repris dans le rapport.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/picking/inputs.py"/>
        <source>Name of the program and of its files; the controller may refuse some</source>
        <translation>Nom du programme et de ses fichiers ; la commande peut en refuser</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Name of the program to call between layers, such as nozzle cleaning.</source>
        <translation>Nom du programme à appeler entre les couches, comme le nettoyage de la buse.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>Name of the programs that are called, without their number: SCHEDULE3.</source>
        <translation>Nom des programmes appelés, sans leur numéro : SCHEDULE3.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>Name or number of the positioner on the controller: mechanical unit of ABB (without one STN1), MACHINE_DEF of KUKA (2), motion group of FANUC (2).</source>
        <translation>Nom ou numéro du positionneur sur la commande : unité mécanique d&apos;ABB (sans indication STN1), MACHINE_DEF de KUKA (2), groupe de mouvement de FANUC (2).</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Narrowest</source>
        <translation>Plus étroit</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/simulation/wording.py"/>
        <source>Near a singularity: condition {value:.3f}, allowed are {than:.3f}</source>
        <translation>Près d&apos;une singularité : condition {value:.3f}, permis {than:.3f}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>New Job…</source>
        <translation>Nouveau travail…</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>New Machine…</source>
        <translation>Nouvelle machine…</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/new_job/panel.py"/>
        <source>New job</source>
        <translation>Nouveau travail</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/preferences/page.py"/>
        <source>New jobs and cells</source>
        <translation>Nouveaux travaux et cellules</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/wizard.py"/>
        <source>New machine</source>
        <translation>Nouvelle machine</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/simulation/fields.py"/>
        <source>Next finding</source>
        <translation>Remarque suivante</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/checks.py"/>
        <source>No axis is asked for more than its largest speed</source>
        <translation>Aucun axe ne doit dépasser sa vitesse maximale</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/simulation/wording.py"/>
        <source>No findings: no limit, singularity or speed comes near</source>
        <translation>Rien à signaler : aucune limite, singularité ou vitesse n&apos;est proche</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/simulation/wording.py"/>
        <source>No findings: no limit, singularity or speed comes near, and no link of the robot touches anything</source>
        <translation>Rien à signaler : aucune limite, singularité ou vitesse n&apos;est proche, et aucun corps du robot ne touche rien</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/preview.py"/>
        <source>No preview: see the field marked.</source>
        <translation>Pas d&apos;aperçu : voyez le champ marqué.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/placement/figures.py"/>
        <source>None of the best is with all points.</source>
        <translation>Aucune des meilleures ne l&apos;est avec tous les points.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/build_direction.py"/>
        <source>Normal of the plane of symmetry-plane, as x y z in the part&apos;s coordinates; auto: the plane of a bend.</source>
        <translation>Normale du plan de symmetry-plane, en x y z dans les coordonnées de la pièce ; auto : le plan d&apos;un coude.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/deposit.py"/>
        <source>Nothing is deposited outside the part</source>
        <translation>Rien n’est déposé à côté de la pièce</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/picking/shape_inputs.py"/>
        <source>Nothing is selected: click in the tree or the 3D view first.</source>
        <translation>Rien n&apos;est sélectionné : cliquez d&apos;abord dans l&apos;arbre ou la vue 3D.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/joint_path.py"/>
        <source>Nothing stands against it so far.</source>
        <translation>Rien ne s&apos;y oppose jusqu&apos;ici.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/inspection/inputs.py"/>
        <source>Nothing was measured: the deposit that the toolpath is predicted to leave</source>
        <translation>Rien n&apos;a été mesuré : le dépôt que la trajectoire d&apos;outil devrait laisser</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>Nozzle</source>
        <translation>Buse</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/toolpath.py"/>
        <source>Number of beads.</source>
        <translation>Nombre de cordons.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/curves_feature.py"/>
        <source>Number of curves.</source>
        <translation>Nombre de courbes.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/toolpath.py"/>
        <source>Number of layers.</source>
        <translation>Nombre de couches.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/toolpath.py"/>
        <source>Number of points of all beads.</source>
        <translation>Nombre de points de tous les cordons.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/inspection.py"/>
        <source>Number of points that count.</source>
        <translation>Nombre de points qui comptent.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/developable_feature.py"/>
        <source>Number of solids.</source>
        <translation>Nombre de solides.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Number of the analogue input that the sensor is on.</source>
        <translation>Numéro de l&apos;entrée analogique du capteur.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Number of the controller&apos;s own weave that beads are laid with; 0 or none: straight.</source>
        <translation>Numéro du balayage propre à la commande avec lequel les cordons sont déposés ; 0 ou aucun : droits.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Number of the digital input to wait for between layers.</source>
        <translation>Numéro de l&apos;entrée logique à attendre entre les couches.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Number of the schedule by which the welder or extruder lays beads; program.schedule says how it is sent.</source>
        <translation>Numéro qui dit au poste de soudage ou à l&apos;extrudeuse comment déposer les cordons ; program.schedule dit comment il est transmis.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>Number of the tool frame named in the program.</source>
        <translation>Numéro du repère outil nommé dans le programme.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>Number of the user frame named in the program.</source>
        <translation>Numéro du repère utilisateur nommé dans le programme.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>Objective</source>
        <translation>Objectif</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>Obstacles</source>
        <translation>Obstacles</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/preferences/page.py"/>
        <source>Of paths, from the least to the greatest</source>
        <translation>Des trajectoires, de la plus petite à la plus grande valeur</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/preferences/page.py"/>
        <source>Of speeds in fields and read-outs; what is typed may have any</source>
        <translation>Des vitesses dans les champs et affichages ; ce qui est saisi peut en avoir une autre</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/source_page.py"/>
        <source>Of the cell</source>
        <translation>De la cellule</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/limits_page.py"/>
        <source>Of the serial angles: each axis against the link before it. Turning axes in deg, deg/s, deg/s² and deg/s³, sliding ones in mm, mm/s, mm/s² and mm/s³. Leave both ends of a range empty for an axis that turns without end, speeds, accelerations and jerks where they are not known.</source>
        <translation>Des angles en série : chaque axe par rapport au corps qui le précède. Axes de rotation en deg, deg/s, deg/s² et deg/s³, de translation en mm, mm/s, mm/s² et mm/s³. Laissez vides les deux bouts d&apos;une plage pour un axe qui tourne sans fin, les vitesses, accélérations et jerks là où ils ne sont pas connus.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/table.py"/>
        <source>Off axis</source>
        <translation>Excentrage</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/source_page.py"/>
        <source>Offset (deg)</source>
        <translation>Décalage (deg)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/source_page.py"/>
        <source>Offset along z, mm</source>
        <translation>Décalage le long de z, mm</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/simulation/fields.py"/>
        <source>On to the next layer</source>
        <translation>À la couche suivante</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/slider_row.py"/>
        <source>One back</source>
        <translation>Un en arrière</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/form.py"/>
        <source>One layer only</source>
        <translation>Une seule couche</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/poses_page.py"/>
        <source>One more row</source>
        <translation>Une ligne de plus</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/slider_row.py"/>
        <source>One on</source>
        <translation>Un en avant</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/simulation/fields.py"/>
        <source>One point back</source>
        <translation>Un point en arrière</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/simulation/fields.py"/>
        <source>One point on</source>
        <translation>Un point en avant</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/controls.py"/>
        <source>One polynomial per bead, or one RZ for the whole job</source>
        <translation>Un polynôme par cordon, ou un RZ pour tout le travail</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>One polynomial per layer, one value per point, or one value for the whole job.</source>
        <translation>Un polynôme par couche, une valeur par point, ou une valeur pour tout le travail.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/poses_page.py"/>
        <source>One pose is that of the serial zeros, where the controller shows {}.</source>
        <translation>Une pose est celle des zéros en série, où la commande montre {}.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Open Part…</source>
        <translation>Ouvrir une pièce…</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/open_part.py"/>
        <source>Open part</source>
        <translation>Ouvrir une pièce</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Opens a part or mesh from a file, which may be damaged: it is read in a process of its own</source>
        <translation>Ouvre une pièce ou un maillage d&apos;un fichier, qui peut être abîmé : il est lu dans un processus à part</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/whats_this.py"/>
        <source>Opens the pages of the tools</source>
        <translation>Ouvre les pages des outils</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Order</source>
        <translation>Ordre</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>Origin</source>
        <translation>Origine</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/simulation/wording.py"/>
        <source>Out of reach</source>
        <translation>Hors d&apos;atteinte</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>Output</source>
        <translation>Sortie</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/solid.py"/>
        <source>Overhang &gt; {}°</source>
        <translation>Surplomb &gt; {}°</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/solid.py"/>
        <source>Overhang &gt; {}°: {:.4g} cm² ({:.0f} %)</source>
        <translation>Surplomb &gt; {}° : {:.4g} cm² ({:.0f} %)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Overlap</source>
        <translation>Recouvrement</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Overlap of neighbouring beads as a share of the bead width; takes the place of the bead spacing.</source>
        <translation>Recouvrement de cordons voisins en part de la largeur de cordon ; tient lieu de la distance des cordons.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/fanuc/read.py"/>
        <source>P[{0}] is not recorded</source>
        <translation>P[{0}] n&apos;est pas enregistré</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/fanuc/read.py"/>
        <source>P[{0}] is recorded in another U{1} than the one selected</source>
        <translation>P[{0}] est enregistré dans un autre U{1} que celui qui est choisi</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/inspection.py"/>
        <source>Pairs</source>
        <translation>Paires</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Parallel contours, parallel lines, or either linked: connected, spiral, zigzag; below 100 % also grid, triangles, honeycomb, gyroid.</source>
        <translation>Contours parallèles, lignes parallèles, ou l&apos;un ou l&apos;autre reliés : contours reliés, spirale, zigzag ; au-dessous de 100 % aussi grille, triangles, nid d&apos;abeilles, gyroïde.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/new_job/panel.py"/>
        <source>Part of revolution</source>
        <translation>Pièce de révolution</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/open_part.py"/>
        <source>Parts, meshes and tables of points ({})</source>
        <translation>Pièces, maillages et tableaux de points ({})</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/dock.py"/>
        <source>Path</source>
        <translation>Trajectoire</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/staubli/post.py"/>
        <source>Payload is set and the monitor speed is 100 %</source>
        <translation>La charge est réglée et la vitesse moniteur est de 100 %</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/fanuc/post.py"/>
        <source>Payload is set and the override is 100 %</source>
        <translation>La charge est réglée et la correction de vitesse est de 100 %</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/ur/post.py"/>
        <source>Payload is set, safety limits allow the speeds, and the speed slider is at 100 %</source>
        <translation>La charge est réglée, les limites de sécurité permettent les vitesses, et le curseur de vitesse est à 100 %</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/picking/pick_field.py"/>
        <source>Pick</source>
        <translation>Choisir</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/placement/dock.py"/>
        <source>Placement of {}</source>
        <translation>Placement de {}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Placement…</source>
        <translation>Placement…</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/form.py"/>
        <source>Plan constant, point-by-point and layer-by-layer on this branch, to look at</source>
        <translation>Planifier constant, point par point et couche par couche sur cette branche, pour regarder</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/context_menu.py"/>
        <source>Plan joint path…</source>
        <translation>Planifier la trajectoire articulaire…</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/form.py"/>
        <source>Plan the joint path again layer by layer, without a curve that is given</source>
        <translation>Replanifier la trajectoire articulaire couche par couche, sans courbe donnée</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/build_direction.py"/>
        <source>Plane</source>
        <translation>Plan</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/inspection/inputs.py"/>
        <source>Planned</source>
        <translation>Prévu</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/inspection/inputs.py"/>
        <source>Planned is missing; it was deleted, choose another</source>
        <translation>Planned manque ; il a été supprimé, choisissez-en un autre</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/inspection.py"/>
        <source>Planned thickness of the wall, half of it on each side of the planned surface; 0: the planned surface itself is the measured one.</source>
        <translation>Épaisseur prévue de la paroi, une moitié de chaque côté de la surface prévue ; 0 : la surface prévue elle-même est celle mesurée.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/comparison.py"/>
        <source>Planning</source>
        <translation>Planification</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Plans the joint values of a toolpath in a cell</source>
        <translation>Planifie les valeurs articulaires d&apos;une trajectoire d&apos;outil dans une cellule</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>Platform</source>
        <translation>Plateau</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>Platform diameter</source>
        <translation>Diamètre du plateau</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/simulation/fields.py"/>
        <source>Play or pause</source>
        <translation>Jouer ou suspendre</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Plays a joint path or program with its machine</source>
        <translation>Joue une trajectoire articulaire ou un programme avec sa machine</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/dock.py"/>
        <source>Plots</source>
        <translation>Graphiques</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Plots joints against limits, distances between layers and deposit rates</source>
        <translation>Trace les articulations par rapport à leurs limites, les distances entre couches et les débits de dépôt</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/canvas.py"/>
        <source>Plots need matplotlib, which is not installed.</source>
        <translation>Les graphiques demandent matplotlib, qui n&apos;est pas installé.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Plots…</source>
        <translation>Graphiques…</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/form.py"/>
        <source>Point</source>
        <translation>Point</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/placement/figures.py"/>
        <source>Points</source>
        <translation>Points</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/inspection/inputs.py"/>
        <source>Points and meshes</source>
        <translation>Points et maillages</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/export_path.py"/>
        <source>Points are left out as long as the path stays within this distance</source>
        <translation>Des points sont laissés de côté tant que la trajectoire reste à cette distance</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/export_path.py"/>
        <source>Points are left out as long as the tool axis stays within this angle</source>
        <translation>Des points sont laissés de côté tant que l&apos;axe de l&apos;outil reste dans cet angle</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>Points as joint values, or as positions of the tool.</source>
        <translation>Points en valeurs articulaires, ou en positions de l&apos;outil.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/place.py"/>
        <source>Points of the toolpath that each pose is judged by, about.</source>
        <translation>Points de la trajectoire d&apos;outil par lesquels chaque pose est jugée, environ.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/placement/figures.py"/>
        <source>Points served, %</source>
        <translation>Points desservis, %</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/figures.py"/>
        <source>Points that are unreachable, past a limit, near a singularity or not allowed</source>
        <translation>Points hors d&apos;atteinte, au-delà d&apos;une limite, près d&apos;une singularité ou non permis</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/inspection.py"/>
        <source>Points up to this far above or below such a height count there, slid along the planned surface.</source>
        <translation>Les points jusqu&apos;à cette distance au-dessus ou au-dessous d&apos;une telle hauteur y comptent, glissés le long de la surface prévue.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>Polynomials give</source>
        <translation>Les polynômes donnent</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/poses_page.py"/>
        <source>Pose {}</source>
        <translation>Pose {}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/source_page.py"/>
        <source>Poses before the first row and after the last, where the table has some</source>
        <translation>Poses avant la première ligne et après la dernière, si le tableau en a</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/placement/form.py"/>
        <source>Poses to try</source>
        <translation>Poses à essayer</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/source_page.py"/>
        <source>Positioner</source>
        <translation>Positionneur</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/clearance.py"/>
        <source>Positioner and track stay clear of nozzle, torch, robot and obstacles</source>
        <translation>Le positionneur et la voie restent à l’écart de la buse, de la torche, du robot et des obstacles</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/preferences/page.py"/>
        <source>Post</source>
        <translation>Post-processeur</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/inspection/inputs.py"/>
        <source>Predicted</source>
        <translation>Prédit</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>Predicted height by layer</source>
        <translation>Hauteur prévue par couche</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>Predicted height of the bead</source>
        <translation>Hauteur prévue du cordon</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>Predicted heights</source>
        <translation>Hauteurs prévues</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>Predicted width of the bead</source>
        <translation>Largeur prévue du cordon</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>Predicted widths and speeds</source>
        <translation>Largeurs et vitesses prévues</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/program/preflight_list.py"/>
        <source>Preflight: {} kept, {} broken, {} not checked</source>
        <translation>Contrôle avant départ : {} tenues, {} non tenues, {} non vérifiées</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/joint_path.py"/>
        <source>Preview of all points; OK looks at the rapid moves too.</source>
        <translation>Aperçu de tous les points ; OK examine aussi les rapides.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/joint_path.py"/>
        <source>Preview of one bead in {}; OK looks at those between and at the rapid moves too.</source>
        <translation>Aperçu d&apos;un cordon sur {} ; OK examine aussi ceux entre eux et les rapides.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/joint_path.py"/>
        <source>Preview of one point in {} of one bead in {}; OK looks at those between and at the rapid moves too.</source>
        <translation>Aperçu d&apos;un point sur {} d&apos;un cordon sur {} ; OK examine aussi ceux entre eux et les rapides.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/joint_path.py"/>
        <source>Preview of one point in {}; OK looks at those between and at the rapid moves too.</source>
        <translation>Aperçu d&apos;un point sur {} ; OK examine aussi ceux entre eux et les rapides.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/inspection.py"/>
        <source>Probe radius</source>
        <translation>Rayon du palpeur</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/toolpath.py"/>
        <source>Process</source>
        <translation>Procédé</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/preferences/page.py"/>
        <source>Process of new toolpaths</source>
        <translation>Procédé des nouvelles trajectoires d&apos;outil</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/program.py"/>
        <source>Program</source>
        <translation>Programme</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/preferences/page.py"/>
        <source>Programs</source>
        <translation>Programmes</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/suggestions.py"/>
        <source>Programs for this machine need what only its controller knows, its pulses per degree, in a machine file of your own. All is planned, checked and simulated without; Export Path… writes its points as a table.</source>
        <translation>Les programmes de cette machine demandent ce que seule sa commande indique, ses impulsions par degré, dans un fichier machine à vous. Tout est planifié, contrôlé et simulé sans elles ; Export Path… écrit les points dans un tableau.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/suggestions.py"/>
        <source>Programs for this machine&apos;s controller are of positions, and what it calls the configurations of this wrist is not known: all is planned, checked and simulated, but no program is written.</source>
        <translation>Les programmes de la commande de cette machine sont faits de positions, et on ne sait pas comment elle nomme les configurations de ce poignet : tout est planifié, vérifié et simulé, mais aucun programme n&apos;est écrit.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/suggestions.py"/>
        <source>Programs for this machine&apos;s controller need the tool on the robot. With the part on it all is planned, checked and simulated, but no program is written.</source>
        <translation>Les programmes de la commande de cette machine demandent l&apos;outil sur le robot. Avec la pièce sur le robot, tout est planifié, vérifié et simulé, mais aucun programme n&apos;est écrit.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Program…</source>
        <translation>Programme…</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/cell/proposing.py"/>
        <source>Proposed for the job of {}; enter what yours really has.</source>
        <translation>Proposé pour la tâche de {} ; saisissez ce qu&apos;il en est du vôtre.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/cell/proposing.py"/>
        <source>Proposed for {}; enter what yours really has.</source>
        <translation>Proposé pour {} ; saisissez ce qu&apos;il en est du vôtre.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/place.py"/>
        <source>Proven</source>
        <translation>Prouvées</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/yaskawa/post.py"/>
        <source>Pulses per degree of the machine file are the controller&apos;s, and zero pulses the zero of its angles</source>
        <translation>Les impulsions par degré du fichier machine sont celles de la commande, et zéro impulsion le zéro de ses angles</translation>
    </message>
    <message>
        <location filename="../../freecad_am/read_back/points.py"/>
        <source>PyKDL and the joint-frame chain disagree</source>
        <translation>PyKDL et la chaîne des repères articulaires ne s&apos;accordent pas</translation>
    </message>
    <message>
        <location filename="../../freecad_am/read_back/points.py"/>
        <source>PyKDL is not installed; the program was checked by one solver only</source>
        <translation>PyKDL n&apos;est pas installé ; le programme a été vérifié par un seul solveur</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/table.py"/>
        <source>RMS</source>
        <translation>RMS</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/place.py"/>
        <source>RX</source>
        <translation>RX</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/place.py"/>
        <source>RY</source>
        <translation>RY</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/map_file.py"/>
        <source>RZ</source>
        <translation>RZ</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/controls.py"/>
        <source>RZ as in Chalvin 2020, the true rotation about the tool axis, or another external axis than across</source>
        <translation>RZ comme dans Chalvin 2020, la vraie rotation autour de l&apos;axe de l&apos;outil, ou un autre axe externe que celui en travers</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/choices.py"/>
        <source>RZ of the paper</source>
        <translation>RZ de l&apos;article</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Radius</source>
        <translation>Rayon</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Radius of the base circle; auto: the face chosen, or the one that the solids stand on.</source>
        <translation>Rayon du cercle de base ; auto : la face choisie, ou celle sur laquelle reposent les solides.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/inspection.py"/>
        <source>Radius of the probe&apos;s ball where its centre was measured; 0 where the points lie on the surface.</source>
        <translation>Rayon de la bille du palpeur si son centre a été mesuré ; 0 si les points sont sur la surface.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/table.py"/>
        <source>Radius of the sphere</source>
        <translation>Rayon de la sphère</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Ramp</source>
        <translation>Rampe</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/simulation/wording.py"/>
        <source>Rapid moves</source>
        <translation>Mouvements rapides</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/export_path.py"/>
        <source>Rapid moves too</source>
        <translation>Rapides aussi</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Rapid speed</source>
        <translation>Vitesse rapide</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/placement/form.py"/>
        <source>Reach of the robot</source>
        <translation>Portée du robot</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/context_menu.py"/>
        <source>Read the text…</source>
        <translation>Lire le texte…</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/name_page.py"/>
        <source>Remarks</source>
        <translation>Remarques</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/feature_order.py"/>
        <source>Remove</source>
        <translation>Retirer</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/context_menu.py"/>
        <source>Renew</source>
        <translation>Renouveler</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>Repeat</source>
        <translation>Répéter</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/inspection/panel.py"/>
        <source>Result</source>
        <translation>Résultat</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Retreat</source>
        <translation>Retour en fin de cordon</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/source_page.py"/>
        <source>Robot</source>
        <translation>Robot</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/export_path.py"/>
        <source>Robot trajectory in this document</source>
        <translation>Trajectoire Robot ici</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/background/busy.py"/>
        <source>Robotic AM</source>
        <translation>Robotic AM</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/preferences/page.py"/>
        <source>Robotic AM, preferences: {}</source>
        <translation>Robotic AM, préférences : {}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/build_direction.py"/>
        <source>Robots with a positioner: largest angle between the tool axis and the vertical of the cell while depositing; the positioner turns the part so far. 180 deg: it stands still.</source>
        <translation>Robots avec positionneur : plus grand angle entre l&apos;axe de l&apos;outil et la verticale de la cellule pendant le dépôt ; le positionneur tourne la pièce en conséquence. 180 deg : il reste immobile.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>Robots: external axes that carry the part or the robot, such as: motoman-motopos-d500 at 1500 0 0 0 0 0 carries part. x y z mm, RX RY RZ deg of the base in the world, which is the robot&apos;s base frame; more than one with ; between.</source>
        <translation>Robots : axes à côté d&apos;eux qui portent la pièce ou le robot, par exemple : motoman-motopos-d500 at 1500 0 0 0 0 0 carries part. x y z en mm, RX RY RZ en deg de la base dans le monde, qui est le repère de base du robot ; plusieurs séparés par ;.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>Robots: file of the torch as closed solids, mm, its tip at the origin, Z out of the nozzle; what lies beyond the length of the nozzle keeps the arm&apos;s clearance as links do.</source>
        <translation>Robots : fichier de la torche en solides fermés, en mm, sa pointe à l&apos;origine, Z sortant de la buse ; ce qui dépasse la longueur de la buse garde la distance du bras comme les segments.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>Robots: how far the links stay from part, deposit, platform, fixtures and nozzle, rapids included; left out, planning does not look at them.</source>
        <translation>Robots : distance que les corps du bras gardent à la pièce, au dépôt, à la plateforme, aux montages et à la buse, déplacements rapides compris ; sans valeur, la planification ne les regarde pas.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>Robots: shoulder, elbow and wrist, or auto to search all eight.</source>
        <translation>Robots : épaule, coude et poignet, ou auto pour chercher parmi les huit.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>Robots: what stands in the cell, which nozzle, part and links are kept clear of, such as: table = table.step at 0 0 -200 0 0 0; post = box 60 60 400 at 900 200 0 0 0 0. x y z mm, RX RY RZ deg of the file&apos;s origin, or of the middle of the box, in the maker&apos;s base frame.</source>
        <translation>Robots : ce qui se trouve dans la cellule et que la buse, la pièce et les segments évitent, par exemple : table = table.step at 0 0 -200 0 0 0 ; post = box 60 60 400 at 900 200 0 0 0 0. x y z mm, RX RY RZ deg de l&apos;origine du fichier, ou du milieu de la boîte, dans le repère de base du constructeur.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>Robots: where the deposit comes out, its Z pointing to the tool; with the tool on the robot, the fixed platform. In the maker&apos;s base frame.</source>
        <translation>Robots : là où sort le dépôt, son Z pointant vers l&apos;outil ; avec l&apos;outil sur le robot, le plateau fixe. Dans le repère de base du constructeur.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/table.py"/>
        <source>Root mean square</source>
        <translation>Moyenne quadratique</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>Rotary table only: which of the two turning axes, counted from the torch, stands still (four axes).</source>
        <translation>Plateau rotatif seulement : lequel des deux axes de rotation, comptés à partir de la torche, reste immobile (quatre axes).</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>Rotation range</source>
        <translation>Plage de rotation</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>Rotation range from</source>
        <translation>Plage de rotation de</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>Rotation range to</source>
        <translation>Plage de rotation à</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>SINUMERIK: block compressor (COMPCAD) in beads whose feed is a speed.</source>
        <translation>SINUMERIK : compresseur de blocs (COMPCAD) dans les cordons dont l&apos;avance est une vitesse.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>SINUMERIK: rounding (G642), jerk limit (SOFT) and feed forward (FFWON).</source>
        <translation>SINUMERIK : arrondi (G642), limitation du jerk (SOFT) et anticipation (FFWON).</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/export_path.py"/>
        <source>STEP file of wires</source>
        <translation>Fils en STEP</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/dock.py"/>
        <source>Save as an image (PNG, SVG, PDF), or the values (CSV)</source>
        <translation>Enregistrer comme image (PNG, SVG, PDF), ou les valeurs (CSV)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/context_menu.py"/>
        <source>Save cell</source>
        <translation>Enregistrer la cellule</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/context_menu.py"/>
        <source>Save cell…</source>
        <translation>Enregistrer la cellule…</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/inspection/panel.py"/>
        <source>Save figures</source>
        <translation>Enregistrer les chiffres</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/inspection/panel.py"/>
        <source>Save figures…</source>
        <translation>Enregistrer les chiffres…</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/map_file.py"/>
        <source>Save the map</source>
        <translation>Enregistrer la carte</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/saving.py"/>
        <source>Save the plot</source>
        <translation>Enregistrer le graphique</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/dock.py"/>
        <source>Save…</source>
        <translation>Enregistrer…</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/toolpath.py"/>
        <source>Scan</source>
        <translation>Numérisation</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/scan.py"/>
        <source>Scan band</source>
        <translation>Bande de numérisation</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/scan.py"/>
        <source>Scan within</source>
        <translation>Numérisation à moins de</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Schedule</source>
        <translation>Programme de soudage</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Schedule that is sent there, without a stop.</source>
        <translation>Programme de soudage qui y est transmis, sans arrêt.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Seam</source>
        <translation>Couture</translation>
    </message>
    <message>
        <location filename="../../freecad_am/plots/process.py"/>
        <source>Section of layer {0}</source>
        <translation>Section de la couche {0}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>Section of the last layer</source>
        <translation>Section de la dernière couche</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/new_job/proposal.py"/>
        <source>Select also, with Ctrl, the faces to deposit on {}.</source>
        <translation>Sélectionnez aussi, avec Ctrl, les faces à déposer sur {}.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/new_job/proposal.py"/>
        <source>Select also, with Ctrl, the hub: a cylinder or cone.</source>
        <translation>Sélectionnez aussi, avec Ctrl, le moyeu : un cylindre ou un cône.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/new_job/proposal.py"/>
        <source>Select also, with Ctrl, the part that it grows on.</source>
        <translation>Sélectionnez aussi, avec Ctrl, la pièce sur laquelle il croît.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/picking/shape_inputs.py"/>
        <source>Select the shape to deposit, or its faces, and press Use selection.</source>
        <translation>Sélectionnez la forme à déposer, ou ses faces, et cliquez sur Prendre.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Sets the travel speed so that beads keep their width in bends: none, csw (steel, Dai 2020), li-2025 (aluminium), or the path of a calibration table.</source>
        <translation>Règle la vitesse d&apos;avance pour que les cordons gardent leur largeur dans les courbes : none, csw (acier, Dai 2020), li-2025 (aluminium), ou le chemin d&apos;une table d&apos;étalonnage.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/new_job/panel.py"/>
        <source>Setup</source>
        <translation>Installation</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/feature_order.py"/>
        <source>Several features: one after the other, or of all layers the lowest first</source>
        <translation>Plusieurs éléments : l&apos;un après l&apos;autre, ou de toutes les couches la plus basse d&apos;abord</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>Shape</source>
        <translation>Forme</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Share of the area inside of the walls that beads fill: their length times their spacing.</source>
        <translation>Part de la surface à l&apos;intérieur des contours que les cordons remplissent : leur longueur multipliée par leur écartement.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Share of the layer height by which layers along a guide may be higher or lower beside it.</source>
        <translation>Part de la hauteur de couche dont les couches le long d&apos;un guide peuvent être plus hautes ou plus basses à côté de lui.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>Share of the layer height by which the local distance of smooth layers may differ; of iso-parameter layers, before there is a warning.</source>
        <translation>Part de la hauteur de couche dont la distance locale des couches smooth peut différer ; pour les couches iso-parameter, avant un avertissement.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/inspection.py"/>
        <source>Share of the points within tolerance (%).</source>
        <translation>Part des points dans la tolérance (%).</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/inspection.py"/>
        <source>Share of the points, those farthest off, that the fit leaves out.</source>
        <translation>Part des points, les plus écartés, que l&apos;ajustement laisse de côté.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Shielding gas; carried along.</source>
        <translation>Gaz de protection ; transmis tel quel.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Shortest</source>
        <translation>Minimum</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>Shoulder, elbow and wrist of this joint path; cell: as the cell says.</source>
        <translation>Épaule, coude et poignet de cette trajectoire articulaire ; cell : ce que dit la cellule.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/controls.py"/>
        <source>Shoulder, elbow and wrist; behind it the share of the map that it reaches within its limits</source>
        <translation>Épaule, coude et poignet ; derrière, la part de la carte qu&apos;elle atteint dans ses limites</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/form.py"/>
        <source>Show all</source>
        <translation>Tout montrer</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/dock.py"/>
        <source>Show all there is; so does a double click</source>
        <translation>Montrer tout ; un double-clic aussi</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/views/cell.py"/>
        <source>Show machine</source>
        <translation>Montrer la machine</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/context_menu.py"/>
        <source>Show path layer by layer</source>
        <translation>Montrer la trajectoire couche par couche</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/cell.py"/>
        <source>Show the machine</source>
        <translation>Montrer la machine</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/context_menu.py"/>
        <source>Show this job only</source>
        <translation>Montrer ce travail seul</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/placement/form.py"/>
        <source>Show where the robot can hold what it carries: blue in few directions, yellow in all of them</source>
        <translation>Montrer où le robot peut tenir ce qu&apos;il porte : bleu dans peu de directions, jaune dans toutes</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/figures.py"/>
        <source>Shown on the map</source>
        <translation>Montré sur la carte</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Shows a toolpath or joint path layer by layer and point by point</source>
        <translation>Montre une trajectoire d&apos;outil ou articulaire couche par couche et point par point</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/frames_page.py"/>
        <source>Shows at zero</source>
        <translation>Montre à zéro</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/cell.py"/>
        <source>Shows the machine at rest while the panel is open, the nozzle upright on the highest point of the path</source>
        <translation>Montre la machine au repos tant que le panneau est ouvert, la buse droite sur le point le plus haut de la trajectoire</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Shows the path against the rotation about the tool; the curve can be drawn by hand</source>
        <translation>Montre la trajectoire en fonction de la rotation autour de l&apos;outil ; la courbe peut être tracée à la main</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Side</source>
        <translation>Côté</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/frames_page.py"/>
        <source>Sign</source>
        <translation>Signe</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/post.py"/>
        <source>Signals do1, di1 and so on have these names</source>
        <translation>Les signaux portent les noms do1, di1 et ainsi de suite</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Simulate…</source>
        <translation>Simuler…</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/simulation/tool.py"/>
        <source>Simulation</source>
        <translation>Simulation</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/simulation/dock.py"/>
        <source>Simulation of {title}</source>
        <translation>Simulation de {title}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/name_page.py"/>
        <source>Six axes that turn, without a spherical wrist.</source>
        <translation>Six axes rotatifs, sans poignet sphérique.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Slowest</source>
        <translation>Le plus lent</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Slowest travel speed at which the material is laid; slower beads are reported.</source>
        <translation>Vitesse d&apos;avance la plus lente à laquelle le matériau est déposé ; les cordons plus lents sont signalés.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>Smallest condition allowed; auto: at each point a quarter of its value at RZ = 0, but at least 0.02.</source>
        <translation>Plus petite condition permise ; auto : en chaque point un quart de sa valeur à RZ = 0, mais au moins 0.02.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/joint_path.py"/>
        <source>Smallest condition of the Jacobian while depositing.</source>
        <translation>Plus petite condition du jacobien pendant le dépôt.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>Smooth</source>
        <translation>Lisser</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>So many layers under tops and over bottoms are filled at 100 %.</source>
        <translation>Nombre de couches remplies à 100 % sous les faces supérieures et au-dessus des faces inférieures.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/place.py"/>
        <source>So many of the best poses are planned with all points, until one is feasible.</source>
        <translation>Autant des meilleures poses sont planifiées avec tous les points, jusqu&apos;à ce que l&apos;une soit réalisable.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Solid layers</source>
        <translation>Couches pleines</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/hub.py"/>
        <source>Solids</source>
        <translation>Solides</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/new_job/panel.py"/>
        <source>Solids in plane layers</source>
        <translation>Solides en couches planes</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Solids on Hub…</source>
        <translation>Solides sur moyeu…</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/new_job/panel.py"/>
        <source>Solids on a hub</source>
        <translation>Solides sur un moyeu</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/hub.py"/>
        <source>Solids on hub</source>
        <translation>Solides sur moyeu</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Solids that touch or overlap are deposited as one (auto), or each by itself (none).</source>
        <translation>Les solides qui se touchent ou se recouvrent sont déposés comme un seul (auto), ou chacun pour soi (none).</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/new_job/panel.py"/>
        <source>Solids without support</source>
        <translation>Solides sans support</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/revolution/wall.py"/>
        <source>Solid{0} ({1} to {2})</source>
        <translation>Solid{0} ({1} à {2})</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Solid…</source>
        <translation>Solide…</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/feature.py"/>
        <source>Source</source>
        <translation>Source</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/curves_feature.py"/>
        <source>Source is missing; choose edges, a wire, a sketch or a table of points</source>
        <translation>Source manque ; choisissez des arêtes, un fil, une esquisse ou un tableau de points</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/shapes/chosen.py"/>
        <source>Source is missing; choose the shape to deposit, or some of its faces</source>
        <translation>Source manque ; choisissez la forme à déposer, ou certaines de ses faces</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>Spacing</source>
        <translation>Espacement</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Spacing range</source>
        <translation>Plage d&apos;écartement</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Spacing range from</source>
        <translation>Écartement de</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Spacing range to</source>
        <translation>Écartement à</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/limits_page.py"/>
        <source>Speed</source>
        <translation>Vitesse</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>Speed along the path</source>
        <translation>Vitesse le long de la trajectoire</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Speed between beads.</source>
        <translation>Vitesse entre les cordons.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Speed of the torch along the deposit while depositing.</source>
        <translation>Vitesse de la torche le long du dépôt.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Speed of the torch there.</source>
        <translation>Vitesse de la torche à cet endroit.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Speed of the wire: constant, or in proportion to the travel speed that a bead model sets, so that beads keep their section.</source>
        <translation>Vitesse du fil : constante, ou proportionnelle à la vitesse d&apos;avance que règle un modèle de cordon, pour que les cordons gardent leur section.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Speed of the wire; auto: what makes beads of their width and the layer height at the travel speed, or what the beads of the bead model were made with. 0: no wire.</source>
        <translation>Vitesse du fil ; auto : celle qui fait des cordons de leur largeur et de la hauteur de couche à la vitesse d&apos;avance, ou celle des cordons du modèle de cordon. 0 : pas de fil.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/table.py"/>
        <source>Spherical defect</source>
        <translation>Défaut de sphéricité</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/table.py"/>
        <source>Spherical defect, least squares</source>
        <translation>Défaut de sphéricité, moindres carrés</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/table.py"/>
        <source>Sphericity</source>
        <translation>Sphéricité</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Stacking direction x y z in the part&apos;s coordinates, from the first layer to the last; auto: the one with the least area over nothing, of these the one with the least height.</source>
        <translation>Direction d&apos;empilement x y z dans les coordonnées de la pièce, de la première couche à la dernière ; auto : celle qui a le moins d&apos;aire au-dessus du vide, et parmi celles-ci la moins haute.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Stand off</source>
        <translation>Distance de buse</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Stand-off of the nozzle; carried along.</source>
        <translation>Distance de la buse à la pièce ; transmise telle quelle.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/table.py"/>
        <source>Standard deviation</source>
        <translation>Écart type</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/inspection.py"/>
        <source>Standard deviation of the deviations.</source>
        <translation>Écart type des écarts.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/table.py"/>
        <source>Standard deviation of the thickness</source>
        <translation>Écart type de l&apos;épaisseur</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/source_page.py"/>
        <source>Standard: Rot(z, theta) Trans(z, d) Trans(x, a) Rot(x, alpha)</source>
        <translation>Standard : Rot(z, theta) Trans(z, d) Trans(x, a) Rot(x, alpha)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/curves.py"/>
        <source>Stands on</source>
        <translation>Repose sur</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Start</source>
        <translation>Début</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/form.py"/>
        <source>Start again from what was planned</source>
        <translation>Repartir de ce qui était planifié</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>Start at</source>
        <translation>Commencer à</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/surface_feature.py"/>
        <source>Start edges</source>
        <translation>Arêtes de départ</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/solid_feature.py"/>
        <source>Start faces</source>
        <translation>Faces de départ</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Starts</source>
        <translation>Départs</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/solid.py"/>
        <source>Starts on</source>
        <translation>Commence sur</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/standing.py"/>
        <source>Status: {}</source>
        <translation>État : {}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/program/window.py"/>
        <source>Status: {}.</source>
        <translation>État : {}.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/table.py"/>
        <source>Std. deviation</source>
        <translation>Écart type</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Step</source>
        <translation>Pas</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/surface_feature.py"/>
        <source>Substrate</source>
        <translation>Substrat</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>Sum of the heights, off the layers</source>
        <translation>Somme des hauteurs, écart aux couches</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>Switch kinematics</source>
        <translation>Commuter la cinématique</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/siemens/post.py"/>
        <source>TRAORI and the work offset are those of the machine file and of the remarks</source>
        <translation>TRAORI et l’origine pièce sont ceux du fichier machine et des remarques</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/toolpath.py"/>
        <source>Tables</source>
        <translation>Tableaux</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/toolpath.py"/>
        <source>Takes the beads that were measured from a file of comma separated values</source>
        <translation>Prend les cordons qui ont été mesurés dans un fichier de valeurs séparées par des virgules</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/feature_order.py"/>
        <source>Takes the chosen feature out of this toolpath</source>
        <translation>Retire l&apos;élément choisi de ce parcours</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Takes the selected edges, wires, sketches or tables to be laid as beads</source>
        <translation>Prend les arêtes, fils, esquisses ou tableaux sélectionnés pour les déposer en cordons</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Takes the selected faces as a wall to be deposited on the other object that is selected</source>
        <translation>Prend les faces sélectionnées comme paroi à déposer sur l&apos;autre objet sélectionné</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Takes the selected faces to be covered with layers of beads</source>
        <translation>Prend les faces sélectionnées pour les recouvrir de couches de cordons</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Takes the selected shape of revolution to be deposited</source>
        <translation>Prend la forme de révolution sélectionnée pour la déposer</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Takes the selected solids to be deposited in plane layers</source>
        <translation>Prend les solides sélectionnés à déposer en couches planes</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Takes the selected solids to be deposited on the cylinder or cone that is selected last</source>
        <translation>Prend les solides sélectionnés pour les déposer sur le cylindre ou le cône sélectionné en dernier</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/picking/shape_inputs.py"/>
        <source>Takes what is selected now. {}</source>
        <translation>Prend ce qui est sélectionné maintenant. {}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Temperature</source>
        <translation>Température</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Temperature in degrees Celsius that a solid, or a wall, has to be below before its next layer; the torch waits above where that begins.</source>
        <translation>Température en degrés Celsius sous laquelle un solide, ou une paroi, doit être avant sa couche suivante ; la torche attend au-dessus de son départ.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Temperature in degrees Celsius; carried along.</source>
        <translation>Température en degrés Celsius ; transmise telle quelle.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/checks.py"/>
        <source>The arm stays clear of part, deposit, platform, nozzle and itself</source>
        <translation>Le bras reste dégagé de la pièce, du dépôt, du plateau, de la buse et de lui-même</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/controls.py"/>
        <source>The bead whose polynomial is shown; a click on the map chooses one</source>
        <translation>Le cordon dont le polynôme est montré ; un clic sur la carte en choisit un</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/placement/figures.py"/>
        <source>The best one was planned with all points.</source>
        <translation>La meilleure a été planifiée avec tous les points.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/joint_path.py"/>
        <source>The cell that runs it.</source>
        <translation>La cellule qui l&apos;exécute.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/toolpath.py"/>
        <source>The cell, for the clearance of nozzle and platform.</source>
        <translation>La cellule, pour le dégagement de la buse et du plateau.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>The controller the program is written for, or none.</source>
        <translation>La commande pour laquelle le programme est écrit, ou none.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/program.py"/>
        <source>The controller&apos;s files; double-click to read and export them.</source>
        <translation>Les fichiers de la commande ; double-cliquez pour les lire et les exporter.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/post.py"/>
        <source>The controller&apos;s world is the robot&apos;s base</source>
        <translation>Le repère monde de la commande est la base du robot</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/staubli/post.py"/>
        <source>The controller&apos;s world is the robot&apos;s base, and joint speeds are its nominal ones</source>
        <translation>Le repère monde de la commande est la base du robot, et les vitesses articulaires sont les nominales</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/hub.py"/>
        <source>The cylinder or cone of the hub to grow on, or the whole hub: then its surface is found under each solid.</source>
        <translation>Le cylindre ou le cône du moyeu sur lequel croître, ou le moyeu entier : alors sa surface est trouvée sous chaque solide.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/developable_feature.py"/>
        <source>The cylinders and cones of the hub to grow on; found when left out.</source>
        <translation>Les cylindres et cônes du moyeu sur lesquels croître ; trouvés s&apos;ils sont omis.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>The deposit is switched on the move itself, this long before a bead&apos;s start or end is reached: the time that its equipment takes. None: where the robot stands.</source>
        <translation>Le dépôt est commuté pendant le mouvement même, ce temps avant que le début ou la fin d&apos;un cordon soit atteint : celui que met son équipement. Sans indication : là où le robot est à l&apos;arrêt.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/fanuc/post.py"/>
        <source>The deposit output switches the process</source>
        <translation>La sortie de dépôt commute le procédé</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/kuka/post.py"/>
        <source>The deposit output switches the process, and a stop of the program switches it off</source>
        <translation>La sortie du dépôt commande le procédé, et un arrêt du programme la coupe</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/linuxcnc/post.py"/>
        <source>The digital and analogue pins are connected to the process</source>
        <translation>Les broches numériques et analogiques sont reliées au procédé</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/figures.py"/>
        <source>The displacement of the joints (Chalvin 2020, eq. 17), and times that of the plan</source>
        <translation>Le déplacement des articulations (Chalvin 2020, éq. 17), et son rapport à celui planifié</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/program/window.py"/>
        <source>The document is closed; open it again to export.</source>
        <translation>Le document est fermé ; ouvrez-le de nouveau pour exporter.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/inspection/panel.py"/>
        <source>The document is closed; open it again to save its figures.</source>
        <translation>Le document est fermé ; ouvrez-le de nouveau pour enregistrer ses chiffres.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/stage.py"/>
        <source>The document or object of this panel is gone; cancel and open the panel again.</source>
        <translation>Le document ou l&apos;objet de ce panneau a disparu ; annulez et ouvrez le panneau de nouveau.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/solid.py"/>
        <source>The edges, wire or sketch that layers along a guide stand normal to; none: the centre line of the solid.</source>
        <translation>Les arêtes, le fil ou l&apos;esquisse auxquels les couches le long d&apos;un guide sont normales ; aucun : la ligne médiane du solide.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/curves.py"/>
        <source>The edges, wire, sketch or table of points to lay as beads.</source>
        <translation>Les arêtes, le fil, l&apos;esquisse ou le tableau de points à déposer en cordons.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/curves_feature.py"/>
        <source>The edges, wire, sketch or table of points to lay as beads; faces beside edges give the directions.</source>
        <translation>Les arêtes, le fil, l&apos;esquisse ou le tableau de points à déposer en cordons ; des faces à côté des arêtes donnent les directions.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/solid.py"/>
        <source>The faces on which the first of geodesic and offset layers lies; none: where they stand.</source>
        <translation>Les faces sur lesquelles repose la première des couches géodésiques ou décalées ; aucune : là où elles sont posées.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/cladding_feature.py"/>
        <source>The faces to cover.</source>
        <translation>Les faces à recouvrir.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/cladding.py"/>
        <source>The faces to cover; of an object that is not a solid all of them, where none is picked.</source>
        <translation>Les faces à recouvrir ; d&apos;un objet qui n&apos;est pas un solide, toutes, si aucune n&apos;est choisie.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/toolpath.py"/>
        <source>The feature to deposit.</source>
        <translation>L&apos;élément à déposer.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/inspection.py"/>
        <source>The feature, toolpath, or object with a shape or mesh that was measured.</source>
        <translation>L&apos;élément, la trajectoire d&apos;outil, ou l&apos;objet à forme ou maillage qui a été mesuré.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/linuxcnc/post.py"/>
        <source>The feed override is 100 %</source>
        <translation>La correction d’avance est de 100 %</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/export_path.py"/>
        <source>The file to write; its ending follows the kind</source>
        <translation>Le fichier à écrire ; son extension suit le type</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/dock.py"/>
        <source>The first layer</source>
        <translation>La première couche</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/form.py"/>
        <source>The first layer that is shown</source>
        <translation>La première couche montrée</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/program.py"/>
        <source>The first lines of the program as it would be written</source>
        <translation>Les premières lignes du programme tel qu&apos;il serait écrit</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/source_page.py"/>
        <source>The frame of the first row in that of the base, and the flange in that of the last row. mm and deg; about X first, then Y, then Z of the outer frame.</source>
        <translation>Le repère de la première ligne dans celui de la base, et la bride dans celui de la dernière ligne. mm et deg ; d&apos;abord autour de X, puis Y, puis Z du repère extérieur.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/developable_feature.py"/>
        <source>The hub; none is needed where it is one of the solids, or the base is given by numbers.</source>
        <translation>Le moyeu ; inutile s&apos;il est l&apos;un des solides, ou si la base est donnée par des nombres.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>The input&apos;s value in a program at 0 degrees Celsius.</source>
        <translation>Valeur de l&apos;entrée dans un programme à 0 degré Celsius.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/new_job/after.py"/>
        <source>The job is ready. Simulate… plays it; double-click Program to read it, Cell to set your machine up.</source>
        <translation>Le travail est prêt. Simuler… le joue ; double-cliquez sur le programme pour le lire, sur la cellule pour régler votre machine.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/new_job/after.py"/>
        <source>The joint path is ready; no post writes a program for this machine and set-up yet. Simulate… plays it, Export Path… writes its points as a table.</source>
        <translation>La trajectoire articulaire est prête ; aucun post-processeur n&apos;écrit encore de programme pour cette machine et cette configuration. Simuler… la joue, Exporter la trajectoire… écrit ses points dans un tableau.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/program.py"/>
        <source>The joint path to write.</source>
        <translation>La trajectoire articulaire à écrire.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/checks.py"/>
        <source>The joints bring the tool to every point</source>
        <translation>Les articulations amènent l’outil à chaque point</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/figures.py"/>
        <source>The largest share of a joint&apos;s greatest speed at the travel speed</source>
        <translation>La plus grande part de la vitesse maximale d&apos;une articulation à la vitesse d&apos;avance</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/dock.py"/>
        <source>The last layer</source>
        <translation>La dernière couche</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/form.py"/>
        <source>The last layer that is shown</source>
        <translation>La dernière couche montrée</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/form.py"/>
        <source>The last point that is shown, counted from 0 in the last layer</source>
        <translation>Le dernier point montré, compté à partir de 0 dans la dernière couche</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/controls.py"/>
        <source>The layer that is shown; -1 for all of them</source>
        <translation>La couche regardée ; -1 pour toutes</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/figures.py"/>
        <source>The least share of half a joint&apos;s range that is left to a limit</source>
        <translation>La plus petite part de la demi-plage d&apos;une articulation qui reste jusqu&apos;à une limite</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/figures.py"/>
        <source>The least sigma_min / sigma_max of the Jacobian</source>
        <translation>Le plus petit sigma_min / sigma_max du jacobien</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/poses_page.py"/>
        <source>The limits of J3 as it is shown can be given on the page before.</source>
        <translation>Les limites de J3 tel qu&apos;il est montré peuvent être données à la page précédente.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/source_page.py"/>
        <source>The link that stands still</source>
        <translation>Le corps qui reste immobile</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/source_page.py"/>
        <source>The link whose frame is the flange, with its Z out of it: tool0 in files of ROS-Industrial</source>
        <translation>Le corps dont le repère est la bride, avec son Z hors d&apos;elle : tool0 dans les fichiers de ROS-Industrial</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/post.py"/>
        <source>The load of t_am is set, and the speed override is 100 %</source>
        <translation>La charge de t_am est réglée, et la vitesse générale est à 100 %</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/poses_page.py"/>
        <source>The machine does not give these poses, and no sign, zero, coupling or frame alone explains it. Look for a slip of typing, the way angles are written, the tool frame, and lengths.</source>
        <translation>La machine ne donne pas ces poses, et aucun signe, zéro, couplage ou repère seul ne l&apos;explique. Cherchez une faute de frappe, l&apos;écriture des angles, le repère outil, et les longueurs.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/poses_page.py"/>
        <source>The machine does not give these poses. It would if:</source>
        <translation>La machine ne donne pas ces poses. Elle le ferait si :</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/poses_page.py"/>
        <source>The machine does not give these poses; three or more would show what is wrong.</source>
        <translation>La machine ne donne pas ces poses ; ce qui est faux peut se dire à partir de trois ou plus.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/poses_page.py"/>
        <source>The machine gives all {} poses, within {} mm.</source>
        <translation>La machine donne toutes les {} poses, à {} mm près.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/name_page.py"/>
        <source>The machine is kept in the folder of your own machines; cells and jobs know it by its name.</source>
        <translation>La machine est gardée dans le dossier de vos propres machines ; cellules et travaux la connaissent par son nom.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/new_job/fields.py"/>
        <source>The machine that deposits, or a saved cell; the program is written for its controller</source>
        <translation>La machine qui dépose, ou une cellule enregistrée ; le programme est écrit pour sa commande</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/drawn/canvas.py"/>
        <source>The map is being computed…</source>
        <translation>La carte est en cours de calcul…</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/dock.py"/>
        <source>The map was closed: {why}</source>
        <translation>La carte a été fermée : {why}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/inspection/inputs.py"/>
        <source>The measured points, or a scanned mesh: {}</source>
        <translation>Les points mesurés, ou un maillage numérisé : {}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/frames_page.py"/>
        <source>The next page compares this with poses of your controller, and says what is likely to be wrong: leave what you do not know as it is.</source>
        <translation>La page suivante compare ceci à des poses de votre commande, et dit ce qui est probablement faux : laissez tel quel ce que vous ne savez pas.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/clearance.py"/>
        <source>The nozzle stays clear of deposit, part and platform while it deposits</source>
        <translation>La buse reste dégagée du dépôt, de la pièce et du plateau pendant le dépôt</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/clearance.py"/>
        <source>The nozzle stays clear on the rapids</source>
        <translation>La buse reste dégagée pendant les rapides</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>The number of a schedule is set on a group output; named by the arc instructions, which then switch the deposit; or is that of a program that is called.</source>
        <translation>Le numéro d&apos;un programme de soudage est mis sur une sortie de groupe ; nommé par les instructions d&apos;arc, qui commutent alors le dépôt ; ou est celui d&apos;un programme appelé.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/staubli/post.py"/>
        <source>The outputs and inputs are linked to the process</source>
        <translation>Les sorties et entrées sont liées au procédé</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/kuka/post.py"/>
        <source>The override is 100 %</source>
        <translation>La vitesse générale est à 100 %</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/deposit.py"/>
        <source>The part lies inside the predicted deposit, by its machining allowance</source>
        <translation>La pièce est à l&apos;intérieur du dépôt prédit, avec sa surépaisseur d&apos;usinage</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/curves.py"/>
        <source>The part that they are laid on; none is needed on a platform.</source>
        <translation>La pièce sur laquelle ils sont déposés ; inutile sur un plateau.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/solid.py"/>
        <source>The part that they stand on; none is needed on a platform.</source>
        <translation>La pièce sur laquelle ils reposent ; aucune n&apos;est nécessaire sur un plateau.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/controls.py"/>
        <source>The path, or an external axis at the point that was clicked last, the other axes as planned there</source>
        <translation>La trajectoire, ou un axe externe au dernier point cliqué, les autres axes comme prévu à cet endroit</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/poses_page.py"/>
        <source>The pendant&apos;s tool frame on the flange (mm, deg); zeros for the flange itself</source>
        <translation>Le repère outil du pupitre sur la bride (mm, deg) ; des zéros pour la bride elle-même</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/placement/dock.py"/>
        <source>The placement was closed: {}</source>
        <translation>Le placement a été fermé : {}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/placement/dock.py"/>
        <source>The pose was entered into {}.</source>
        <translation>La pose a été entrée dans {}.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/deposit.py"/>
        <source>The predicted deposit holds what the wire feeds</source>
        <translation>Le dépôt prédit contient ce que le fil apporte</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/preview.py"/>
        <source>The preview is being computed.</source>
        <translation>L&apos;aperçu est en cours de calcul.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/placement/dock.py"/>
        <source>The robot can be at {} places of a grid of {:.0f} mm.</source>
        <translation>Le robot peut atteindre {} endroits d&apos;une grille de {:.0f} mm.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/ur/post.py"/>
        <source>The robot keeps the time of every move through the blends</source>
        <translation>Le robot tient la durée de chaque mouvement à travers les lissages</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>The same layer of all solids on a base in turn, around the axis, the same ring of each and the inner ones first; or solid by solid (feature).</source>
        <translation>La même couche de tous les solides d&apos;une base tour à tour, autour de l&apos;axe, le même anneau de chacun et les intérieurs d&apos;abord ; ou solide par solide (feature).</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>The same motion without deposit.</source>
        <translation>Le même mouvement sans dépôt.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/scan.py"/>
        <source>The scan was made after this layer, counted from 0: the layers above are fitted to it; none: it is of the bare substrate.</source>
        <translation>La numérisation a été faite après cette couche, comptée à partir de 0 : les couches au-dessus y sont ajustées ; aucune : elle est du substrat nu.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/feature.py"/>
        <source>The shape to deposit, or some of its faces.</source>
        <translation>La forme à déposer, ou certaines de ses faces.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>The side of the faces that is covered: where their normals point, outwards of a solid (front), or the other side of faces that are of no solid (back).</source>
        <translation>Le côté des faces qui est recouvert : celui vers lequel pointent leurs normales, l&apos;extérieur d&apos;un solide (front), ou l&apos;autre côté de faces qui ne sont d&apos;aucun solide (back).</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/simulation/dock.py"/>
        <source>The simulation has ended: {why}.</source>
        <translation>La simulation est terminée : {why}.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/surface_feature.py"/>
        <source>The solid part or closed mesh that the wall grows on; none is needed where edges are chosen.</source>
        <translation>La pièce solide ou le maillage fermé sur lequel croît la paroi ; inutile si des arêtes sont choisies.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/hub.py"/>
        <source>The solids or closed meshes to deposit, one after the other; a click on one again leaves it out.</source>
        <translation>Les solides ou maillages fermés à déposer, l&apos;un après l&apos;autre ; un nouveau clic sur l&apos;un le retire.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/solid_feature.py"/>
        <source>The solids or closed meshes to deposit.</source>
        <translation>Les solides ou maillages fermés à déposer.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/developable_feature.py"/>
        <source>The solids or closed meshes to deposit; or a part and the faces of its hub, where both are one solid.</source>
        <translation>Les solides ou maillages fermés à déposer ; ou une pièce et les faces de son moyeu, si les deux sont un seul solide.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/developable_feature.py"/>
        <source>The surfaces that solids stand on.</source>
        <translation>Les surfaces sur lesquelles reposent les solides.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/written.py"/>
        <source>The text takes the tool to the planned points</source>
        <translation>Le texte amène l’outil aux points planifiés</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/simulation/fields.py"/>
        <source>The time of the job</source>
        <translation>Le temps du travail</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/yaskawa/post.py"/>
        <source>The tool file of the number in the job is the nozzle&apos;s tip, and speeds have the unit of the remarks</source>
        <translation>Le fichier outil du numéro dans le job est la pointe de la buse, et les vitesses ont l&apos;unité des remarques</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/checks.py"/>
        <source>The tool keeps away from singularities while it deposits</source>
        <translation>L’outil reste loin des singularités pendant le dépôt</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/siemens/post.py"/>
        <source>The tool offset has the torch&apos;s length, and G500 is the machine&apos;s zero</source>
        <translation>Le correcteur d’outil a la longueur de la torche, et G500 est le zéro machine</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/linuxcnc/post.py"/>
        <source>The tool table has the torch&apos;s length, and the kinematics has the machine file&apos;s offsets</source>
        <translation>La table d’outils a la longueur de la torche, et la cinématique a les décalages du fichier machine</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/form.py"/>
        <source>The toolpath or joint path to look at</source>
        <translation>La trajectoire d&apos;outil ou articulaire à regarder</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/joint_path.py"/>
        <source>The toolpath to run.</source>
        <translation>La trajectoire d&apos;outil à exécuter.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/export_path.py"/>
        <source>The toolpath, joint path or program to export</source>
        <translation>La trajectoire d&apos;outil, la trajectoire articulaire ou le programme à exporter</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/dock.py"/>
        <source>The toolpath, joint path or program to look at</source>
        <translation>La trajectoire d&apos;outil, la trajectoire articulaire ou le programme à regarder</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/surface_feature.py"/>
        <source>The wall to deposit, or its faces.</source>
        <translation>La paroi à déposer, ou ses faces.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/simulation/fields.py"/>
        <source>The whole job</source>
        <translation>Tout le travail</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/new_job/proposal.py"/>
        <source>The whole of {} is taken. To take single faces, click several with Ctrl; for a single one, use the panel of Feature or Wall on Part.</source>
        <translation>{} est pris en entier. Pour des faces seules, cliquez-en plusieurs avec Ctrl ; pour une seule, utilisez le panneau d’Élément ou de Paroi sur pièce.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/wall.py"/>
        <source>The whole of {} is taken; Pick takes single faces, click by click.</source>
        <translation>{} est pris en entier ; Choisir prend des faces seules, clic par clic.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/picking/shape_inputs.py"/>
        <source>The whole of {} is taken; Use selection takes the selected faces only.</source>
        <translation>{} est pris en entier ; Prendre la sélection prend des faces seules.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/deposit.py"/>
        <source>The wire feeds what the beads take</source>
        <translation>Le fil amène ce que les cordons demandent</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/siemens/post.py"/>
        <source>The words that switch the deposit and the inputs are taken up in the PLC</source>
        <translation>Les mots qui commutent le dépôt et les entrées sont traités dans l’automate</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/picking/pick_field.py"/>
        <source>Then click in the tree or the 3D view. {}</source>
        <translation>Cliquez ensuite dans l&apos;arbre ou la vue 3D. {}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/placement/dock.py"/>
        <source>There is no 3D view to show places in; open one.</source>
        <translation>Il n&apos;y a pas de vue 3D où montrer des endroits ; ouvrez-en une.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/simulation/tool.py"/>
        <source>There is no 3D view to simulate in; open one.</source>
        <translation>Il n&apos;y a pas de vue 3D où simuler ; ouvrez-en une.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/tool.py"/>
        <source>There is no joint path to map; make one first.</source>
        <translation>Il n&apos;y a pas de trajectoire articulaire à cartographier ; faites-en d&apos;abord une.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/simulation/tool.py"/>
        <source>There is no joint path to simulate; make one first.</source>
        <translation>Il n&apos;y a pas de trajectoire articulaire à simuler ; faites-en d&apos;abord une.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/feature_order.py"/>
        <source>There is no other feature in this document; make it first.</source>
        <translation>Il n&apos;y a pas d&apos;autre élément dans ce document ; créez-le d&apos;abord.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/dock.py"/>
        <source>There is no path to look at yet: make a toolpath or a joint path.</source>
        <translation>Il n&apos;y a pas encore de trajectoire à regarder : faites une trajectoire d&apos;outil ou articulaire.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/suggestions.py"/>
        <source>There is no post for this machine&apos;s controller yet: all is planned, checked and simulated, but no program is written. Export Path… writes its points as a table.</source>
        <translation>Il n&apos;y a pas encore de post-processeur pour la commande de cette machine : tout est planifié, vérifié et simulé, mais aucun programme n&apos;est écrit. Exporter une trajectoire… écrit ses points en tableau.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/placement/tool.py"/>
        <source>There is no toolpath with a cell to place; make one first.</source>
        <translation>Il n&apos;y a pas de trajectoire d&apos;outil avec une cellule à placer ; faites-en d&apos;abord une.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/inspection/inputs.py"/>
        <source>There is nothing to compare with in this document; open the part first.</source>
        <translation>Il n&apos;y a rien à quoi comparer dans ce document ; ouvrez d&apos;abord la pièce.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/dock.py"/>
        <source>There is nothing to plot yet: make a toolpath or a joint path.</source>
        <translation>Il n&apos;y a encore rien à tracer : faites une trajectoire d&apos;outil ou articulaire.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/preferences/page.py"/>
        <source>These are proposals of the window for what is made from now on, and its looks. Existing documents, jobs and macros never depend on them.</source>
        <translation>Ce sont des propositions de la fenêtre pour ce qui est fait désormais, et son aspect. Les documents, travaux et macros existants n&apos;en dépendent jamais.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/inspection.py"/>
        <source>Thickness</source>
        <translation>Épaisseur</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Thin</source>
        <translation>Mince</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/consequences.py"/>
        <source>This curve</source>
        <translation>Cette courbe</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/simulation/fields.py"/>
        <source>This is an earlier plan; recompute the document for the present one.</source>
        <translation>C&apos;est une planification antérieure ; recalculez le document pour l&apos;actuelle.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/program/window.py"/>
        <source>This text is of an earlier plan; do not run it.</source>
        <translation>Ce texte est d&apos;une planification antérieure ; ne l&apos;exécutez pas.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/name_page.py"/>
        <source>Three axes that slide and two that turn.</source>
        <translation>Trois axes de translation et deux de rotation.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/build_direction.py"/>
        <source>Tilt</source>
        <translation>Inclinaison</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/simulation/wording.py"/>
        <source>Time</source>
        <translation>Temps</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/joint_path.py"/>
        <source>Time of all moves (s).</source>
        <translation>Temps de tous les mouvements (s).</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/joint_path.py"/>
        <source>Time of depositing moves (s).</source>
        <translation>Temps des mouvements de dépôt (s).</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/joint_path.py"/>
        <source>Time of the whole job with lead times and waits between layers (s).</source>
        <translation>Temps de tout le travail avec avances, retards et attentes entre les couches (s).</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/placement/figures.py"/>
        <source>Time, s</source>
        <translation>Temps, s</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/program.py"/>
        <source>Time: {}, {}</source>
        <translation>Durée : {}, {}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/frames_page.py"/>
        <source>To</source>
        <translation>À</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/form.py"/>
        <source>To layer</source>
        <translation>À la couche</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/source_page.py"/>
        <source>To link</source>
        <translation>Au corps</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/simulation/fields.py"/>
        <source>To the next place where a limit, a singularity or a speed needs attention</source>
        <translation>Au prochain endroit où une limite, une singularité ou une vitesse est à regarder</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/export_path.py"/>
        <source>Tolerance</source>
        <translation>Tolérance</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/poses_page.py"/>
        <source>Tool</source>
        <translation>Outil</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/build_direction.py"/>
        <source>Tool axis turned forward along the bead, from the build direction.</source>
        <translation>Axe de l&apos;outil tourné vers l&apos;avant le long du cordon, à partir de la direction de dépôt.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/build_direction.py"/>
        <source>Tool axis turned sideways, towards the outside of the wall, from the build direction.</source>
        <translation>Axe de l&apos;outil tourné de côté, vers l&apos;extérieur de la paroi, à partir de la direction de dépôt.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>Tool frame</source>
        <translation>Repère outil</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>Tool on robot only: points of the part and where the tip has touched them, three or more, which take the place of the deposition point, such as: 0 0 0 = 900.4 2.1 -99.7; 100 0 0 = 1000.3 1.2 -99.9; 0 80 0 = 901 82 -99.5. In the part file and in the maker&apos;s base frame, mm.</source>
        <translation>Outil sur le robot seulement : points de la pièce et où la pointe les a palpés, trois ou plus, qui remplacent le point de dépôt, par exemple : 0 0 0 = 900.4 2.1 -99.7 ; 100 0 0 = 1000.3 1.2 -99.9 ; 0 80 0 = 901 82 -99.5. Dans le fichier de la pièce et dans le repère de base du constructeur, en mm.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>Tool on robot only: pose of the tip on the flange, its Z pointing out of the nozzle. mm, RX RY RZ.</source>
        <translation>Outil sur le robot seulement : pose du bout sur la bride, son Z pointant hors de la buse. mm, RX RY RZ.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/toolpath.py"/>
        <source>Toolpath</source>
        <translation>Trajectoire d&apos;outil</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Toolpath…</source>
        <translation>Trajectoire d&apos;outil…</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Torch turned outwards about the bead on outer contours.</source>
        <translation>Torche tournée vers l&apos;extérieur autour du cordon sur les contours extérieurs.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>Touched</source>
        <translation>Palpés</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>Touched tolerance</source>
        <translation>Tolérance de palpage</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/source_page.py"/>
        <source>Track</source>
        <translation>Rail</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>Travel speed</source>
        <translation>Vitesse d&apos;avance</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Tries where the part, its positioner or the deposition point can stand, and shows the robot&apos;s reach</source>
        <translation>Essaie où la pièce, son positionneur ou le point de dépôt peut se trouver, et montre la portée du robot</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/process.py"/>
        <source>TriggSpeed follows the speed of linear moves, and these are joint moves</source>
        <translation>TriggSpeed suit la vitesse de mouvements linéaires, et ceux-ci sont des mouvements articulaires</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>Trigger</source>
        <translation>Commutation</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/inspection.py"/>
        <source>Trim</source>
        <translation>Écrêtage</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/placement/form.py"/>
        <source>Try all poses beside the window; it can be cancelled</source>
        <translation>Essayer toutes les poses à côté de la fenêtre ; cela peut être annulé</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/export_path.py"/>
        <source>Turn</source>
        <translation>Rotation</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>Turn of the bead within the wall that smooth layers stay below where the band allows.</source>
        <translation>Rotation du cordon dans la paroi au-dessous de laquelle restent les couches smooth là où la bande le permet.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/source_page.py"/>
        <source>Twist about x, deg</source>
        <translation>Torsion autour de x, deg</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/pendant.py"/>
        <source>Type the pose as this controller&apos;s pendant shows it, X Y Z in mm first</source>
        <translation>Saisissez la pose telle que le pupitre de cette commande l&apos;affiche, X Y Z en mm d&apos;abord</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/fanuc/post.py"/>
        <source>UFRAME and UTOOL of the numbers in the program are those of the cell</source>
        <translation>UFRAME et UTOOL aux numéros du programme sont ceux de la cellule</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/source_page.py"/>
        <source>URDF file</source>
        <translation>Fichier URDF</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/ur/post.py"/>
        <source>URScript has no arc instructions</source>
        <translation>URScript n&apos;a pas d&apos;instructions d&apos;arc</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/ur/post.py"/>
        <source>URScript has no documented output at a time before a place</source>
        <translation>URScript n&apos;a pas de sortie commutée un temps avant un lieu, d&apos;après ce qui est documenté</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/ur/post.py"/>
        <source>URScript has no documented weave of its own</source>
        <translation>URScript n&apos;a pas de balayage propre, d&apos;après la documentation</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/ur/post.py"/>
        <source>URScript moves a tool that the flange carries, at its speed; with the part on the robot the tool stands and the speed at the deposition point is another one at every point of the part, which no documented instruction of URScript holds; use `motion: joint`</source>
        <translation>URScript déplace un outil porté par la bride, à la vitesse de celui-ci ; avec la pièce sur le robot, l&apos;outil est fixe et la vitesse au point de dépôt est une autre en chaque point de la pièce, ce qu&apos;aucune instruction documentée d&apos;URScript ne tient ; utilisez `motion: joint`</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/ur/post.py"/>
        <source>URScript sets an output when the robot enters the blend before it, not where the bead asks for it</source>
        <translation>URScript règle une sortie quand le robot entre dans le lissage qui précède, et non où le cordon la demande</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>Unit</source>
        <translation>Unité</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/preferences/page.py"/>
        <source>Unit of speeds</source>
        <translation>Unité des vitesses</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/inspection.py"/>
        <source>Unit of the measured coordinates; auto: the one that the file names, else mm.</source>
        <translation>Unité des coordonnées mesurées ; auto : celle que nomme le fichier, sinon mm.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/feature_order.py"/>
        <source>Up</source>
        <translation>Monter</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/controls.py"/>
        <source>Upwards</source>
        <translation>Ordonnée</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/checks/predicted_shape.py"/>
        <source>Use beads {0} mm wider on either side, by process.bead_width, or leave less of it to machine</source>
        <translation>Utilisez des cordons plus larges de {0} mm de chaque côté, par process.bead_width, ou laissez moins à usiner</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/picking/shape_inputs.py"/>
        <source>Use selection</source>
        <translation>Prendre</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/placement/form.py"/>
        <source>Use this</source>
        <translation>Utiliser</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>User frame</source>
        <translation>Repère utilisateur</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/yaskawa/read.py"/>
        <source>V has two units</source>
        <translation>V a deux unités</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/staubli/post.py"/>
        <source>VAL 3 has no arc instructions</source>
        <translation>VAL 3 n&apos;a pas d&apos;instructions d&apos;arc</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/staubli/post.py"/>
        <source>VAL 3 has no documented output at a time before a place</source>
        <translation>VAL 3 n&apos;a pas de sortie commutée un temps avant un lieu, d&apos;après ce qui est documenté</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/staubli/post.py"/>
        <source>VAL 3 has no documented weave</source>
        <translation>VAL 3 n&apos;a pas de balayage, d&apos;après la documentation</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/staubli/post.py"/>
        <source>VAL 3 sets outputs while the moves before are still in the queue</source>
        <translation>VAL 3 règle les sorties pendant que les mouvements précédents sont encore dans la file</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/yaskawa/post.py"/>
        <source>VJ is a share of the largest speeds of the machine file, those of the axis that takes longest</source>
        <translation>VJ est une part des plus grandes vitesses du fichier machine, celle de l&apos;axe qui met le plus de temps</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>Value of that output at 1 m/min of wire.</source>
        <translation>Valeur de cette sortie à 1 m/min de fil.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/saving.py"/>
        <source>Values (*.csv)</source>
        <translation>Valeurs (*.csv)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/simulation/wording.py"/>
        <source>Volume</source>
        <translation>Volume</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>Volume by layer</source>
        <translation>Volume par couche</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/joint_path.py"/>
        <source>Volume of the deposit, bead width times layer height (cm³).</source>
        <translation>Volume du dépôt, largeur de cordon fois hauteur de couche (cm³).</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Wait</source>
        <translation>Attente</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/fields/preferences.py"/>
        <source>Wait between layers</source>
        <translation>Attente entre les couches</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/simulation/wording.py"/>
        <source>Waits</source>
        <translation>Attentes</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/wall.py"/>
        <source>Wall</source>
        <translation>Paroi</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Wall on Part…</source>
        <translation>Paroi sur pièce…</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/new_job/panel.py"/>
        <source>Wall on a part</source>
        <translation>Paroi sur une pièce</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/wall.py"/>
        <source>Wall on part</source>
        <translation>Paroi sur pièce</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Walls</source>
        <translation>Contours extérieurs</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Weave</source>
        <translation>Balayage</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>What a joint path is judged by.</source>
        <translation>Ce qui juge une trajectoire articulaire.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/payload.py"/>
        <source>What carries the part carries its weight</source>
        <translation>Ce qui porte la pièce porte son poids</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>What differs for classes of beads (first_layer, contour, fill, closing, link, wall), such as: contour: travel_speed 8, schedule 3; fill: lead 5; or none.</source>
        <translation>Ce qui diffère pour des classes de cordons (first_layer, contour, fill, closing, link, wall), par exemple : contour : travel_speed 8, schedule 3 ; fill : lead 5 ; ou none.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/controls.py"/>
        <source>What is changed of one bead is changed of all</source>
        <translation>Ce qui est changé d&apos;un cordon l&apos;est de tous</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/deposit.py"/>
        <source>What is deposited lies on the part</source>
        <translation>Ce qui est déposé se trouve sur la pièce</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/new_job/panel.py"/>
        <source>What is deposited: click it in the tree or the 3D view</source>
        <translation>Ce qui est déposé : cliquez dessus dans l&apos;arbre ou la vue 3D</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/dock.py"/>
        <source>What is drawn</source>
        <translation>Ce qui est dessiné</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/export_path.py"/>
        <source>What is made of the path</source>
        <translation>Ce qui est fait de la trajectoire</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/place.py"/>
        <source>What is moved: the deposition point (with the tool on the robot the fixed platform), the platform on the flange or the table, or the base of the positioner; auto: the one that places the part.</source>
        <translation>Ce qui est déplacé : le point de dépôt (avec l&apos;outil sur le robot, le plateau fixe), le plateau sur la bride ou la table, ou la base du positionneur ; auto : ce qui place la pièce.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/program/preflight_list.py"/>
        <source>What is promised of this program, how it was checked and where it is worst; a click goes there</source>
        <translation>Ce qui est promis de ce programme, comment cela a été vérifié et où c’est le pire ; un clic y mène</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/new_job/panel.py"/>
        <source>What it grows on: click it with Ctrl in the tree or the 3D view</source>
        <translation>Ce sur quoi cela croît : cliquez dessus avec Ctrl dans l&apos;arbre ou la vue 3D</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/place.py"/>
        <source>What makes a feasible pose the best one: the largest least margin, the shortest time, or the largest distance of the arm from everything.</source>
        <translation>Ce qui fait d&apos;une pose réalisable la meilleure : la plus grande des plus petites marges, le temps le plus court, ou la plus grande distance du bras à tout le reste.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/name_page.py"/>
        <source>What stands beside a robot: a cell names it as external axis.</source>
        <translation>Ce qui se trouve à côté d&apos;un robot : une cellule le nomme comme axe externe.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/form.py"/>
        <source>What the colours of the beads show</source>
        <translation>Ce que disent les couleurs des cordons</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/placement/form.py"/>
        <source>What the colours of the places show</source>
        <translation>Ce que disent les couleurs des endroits</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/controls.py"/>
        <source>What the colours show</source>
        <translation>Ce que disent les couleurs</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/source_page.py"/>
        <source>What the file has beside one another; each gets a machine file of its own</source>
        <translation>Ce que le fichier a côte à côte ; chacun reçoit son propre fichier de machine</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>What the layers are: parallel planes; at equal distances by the way through the part from where it stands, so that nothing needs support (geodesic); at equal distances straight from there (offset); or planes normal to a guide curve (along).</source>
        <translation>Ce que sont les couches : des plans parallèles ; à distances égales par le chemin à travers la pièce depuis là où elle repose, de sorte que rien n&apos;a besoin de support (geodesic) ; à distances égales en ligne droite depuis là (offset) ; ou des plans normaux à une courbe guide (along).</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>What the polynomial gives: the true rotation about the tool axis, or RZ of the paper.</source>
        <translation>Ce que donne le polynôme : la vraie rotation autour de l&apos;axe de l&apos;outil, ou le RZ de l&apos;article.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>What the positions of Cartesian programs are relative to, in the part&apos;s coordinates: x y z mm, RX RY RZ deg; auto: the frame that sits on the platform.</source>
        <translation>À quoi se rapportent les positions des programmes cartésiens, dans les coordonnées de la pièce : x y z mm, RX RY RZ deg ; auto : le repère qui repose sur le plateau.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/new_job/fields.py"/>
        <source>What the robot carries. Where the job cannot be done in the cell that suits the robot, another place, another branch or a positioner is proposed, and the robot shown there.</source>
        <translation>Ce que porte le robot. Si le travail ne peut se faire dans la cellule qui convient au robot, un autre emplacement, une autre branche ou un positionneur est proposé, et le robot y est montré.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Where beads start: where the seam says (aligned), or apart from those of neighbouring contours and layers, lines of every second layer at their other end (spread).</source>
        <translation>Départ des cordons : où le dit la couture (alignés), ou loin de ceux des contours et couches voisins, les lignes d&apos;une couche sur deux par leur autre bout (répartis).</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Where closed beads start.</source>
        <translation>Là où commencent les cordons fermés.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Where in its height a layer takes its outline from the part.</source>
        <translation>À quelle hauteur une couche prend son contour de la pièce.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>Where it takes less motion than a polynomial, the rotation about the tool axis is free at every point of a bead: the best course that is found, for the objective displacement. Takes up to seconds per bead.</source>
        <translation>Là où le mouvement est moindre qu’avec un polynôme, la rotation autour de l’axe de l’outil est libre en chaque point d’un cordon : le meilleur parcours trouvé, pour l’objectif displacement. Prend jusqu’à quelques secondes par cordon.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/preferences/page.py"/>
        <source>Where programs are written first; empty for the folder of last time, or next to the document</source>
        <translation>Là où les programmes sont d&apos;abord écrits ; vide pour le dossier de la dernière fois, ou à côté du document</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/name_page.py"/>
        <source>Where the check poses are from</source>
        <translation>D&apos;où viennent les poses de contrôle</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Where the figures of the material are from; carried to the report.</source>
        <translation>D&apos;où viennent les valeurs du matériau ; repris dans le rapport.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/inspection.py"/>
        <source>Where the fit begins: three or more pairs of a measured point and the same point of the part, each x y z &gt; x y z in mm, with a semicolon between; empty: it is searched for.</source>
        <translation>Là où commence l&apos;ajustement : trois paires ou plus d&apos;un point mesuré et du même point de la pièce, chacune x y z &gt; x y z en mm, séparées par un point-virgule ; vide : il est cherché.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/source_page.py"/>
        <source>Where the geometry comes from</source>
        <translation>D&apos;où vient la géométrie</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>Where the locked axis stands; auto: where the largest angle left is least.</source>
        <translation>Là où se tient l&apos;axe bloqué ; auto : là où le plus grand angle restant est le plus petit.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>Which frame sits on the platform: the feature&apos;s own, or that of the part file.</source>
        <translation>Quel repère repose sur le plateau : celui de l&apos;élément à déposer, ou celui du fichier de la pièce.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>Which of part and tool the robot carries, or a machine with rotary axes.</source>
        <translation>Ce que porte le robot, la pièce ou l&apos;outil, ou une machine à axes rotatifs.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>Which of the controller&apos;s external axes e1 is; the others follow: eax_a, E1 are 1.</source>
        <translation>Lequel des axes externes de la commande est e1 ; les autres suivent : eax_a, E1 sont 1.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>Which set of joint limits of the machine file holds.</source>
        <translation>Quel jeu de limites articulaires du fichier machine vaut.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/inspection.py"/>
        <source>Which side of a wall was measured: that of its outer normals, the inner one, or both.</source>
        <translation>Quel côté d&apos;une paroi a été mesuré : celui de ses normales extérieures, l&apos;intérieur, ou les deux.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>Which wall of a solid is deposited; middle runs halfway between outer and inner.</source>
        <translation>Quelle paroi d&apos;un solide est déposée ; middle court à mi-chemin entre l&apos;extérieure et l&apos;intérieure.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/dock.py"/>
        <source>Whole</source>
        <translation>Tout</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>Widest gap that may stay open between beads, as a share of the bead spacing.</source>
        <translation>Plus large jour qui peut rester ouvert entre les cordons, en part de la distance des cordons.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/fit_plot.py"/>
        <source>Width</source>
        <translation>Largeur</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>Width of beads</source>
        <translation>Largeur des cordons</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Width of the bead; held by the bead model. Solids on hubs are filled with beads that wide.</source>
        <translation>Largeur du cordon ; tenue par le modèle de cordon. Les solides sur moyeux sont remplis de cordons de cette largeur.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/inspection.py"/>
        <source>Width of the narrowest zone between two circles, by height.</source>
        <translation>Largeur de la zone la plus étroite entre deux cercles, par hauteur.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/inspection.py"/>
        <source>Width of the narrowest zone between two spheres that holds all points.</source>
        <translation>Largeur de la zone la plus étroite entre deux sphères qui contient tous les points.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Wire</source>
        <translation>Fil</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/fields/preferences.py"/>
        <source>Wire diameter</source>
        <translation>Diamètre du fil</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/fields/preferences.py"/>
        <source>Wire feed</source>
        <translation>Dévidage du fil</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>Wire gain</source>
        <translation>Gain du fil</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>Wire output</source>
        <translation>Sortie du fil</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/table.py"/>
        <source>Within tolerance</source>
        <translation>Dans la tolérance</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/program.py"/>
        <source>Without a post no file is written.</source>
        <translation>Sans post-processeur, aucun fichier n&apos;est écrit.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/fields.py"/>
        <source>Words: {}.</source>
        <translation>Mots : {}.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>World up</source>
        <translation>Verticale du monde</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/context_menu.py"/>
        <source>Write program…</source>
        <translation>Écrire le programme…</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/export_path.py"/>
        <source>Write the moves between beads as well, on a layer of their own; toolpaths have none</source>
        <translation>Écrire aussi les mouvements entre les cordons, sur un calque à eux ; les trajectoires d&apos;outil n&apos;en ont pas</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Writes a path as STEP or DXF wires, a table or a report, or makes a CAM path or Robot trajectory of it</source>
        <translation>Écrit une trajectoire en fils STEP ou DXF, en tableau ou en rapport, ou en fait une trajectoire CAM ou Robot</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/program/window.py"/>
        <source>Writes all files of the program into a folder</source>
        <translation>Écrit tous les fichiers du programme dans un dossier</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Writes the controller&apos;s program of a joint path</source>
        <translation>Écrit le programme de la commande pour une trajectoire articulaire</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/inspection/panel.py"/>
        <source>Writes the figures and the deviation of every point into a folder</source>
        <translation>Écrit les chiffres et l&apos;écart de chaque point dans un dossier</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/place.py"/>
        <source>X</source>
        <translation>X</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/place.py"/>
        <source>Y</source>
        <translation>Y</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/place.py"/>
        <source>Z</source>
        <translation>Z</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>Zero</source>
        <translation>Zéro</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/dock.py"/>
        <source>Zoom in; so does the wheel, with Ctrl up and down</source>
        <translation>Agrandir ; la molette aussi, avec Ctrl vers le haut et le bas</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/dock.py"/>
        <source>Zoom into a rectangle that the mouse draws; else it moves the picture</source>
        <translation>Agrandir un rectangle tracé à la souris ; sinon elle déplace l&apos;image</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/dock.py"/>
        <source>Zoom out</source>
        <translation>Réduire</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/refusals.py"/>
        <source>`max_speed` to its joints</source>
        <translation>`max_speed` à ses articulations</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/refusals.py"/>
        <source>`velocity` to the `&lt;limit&gt;` of each of its joints</source>
        <translation>`velocity` au `&lt;limit&gt;` de chacune de ses articulations</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/walls/beads.py"/>
        <source>a band of {0} % does not suffice: within the wall {1} of {2} layers turn by more than {3} deg/mm, first layer {4}, by up to {5} deg/mm elsewhere. The robot slows down there; a wider strategy.band rounds them</source>
        <translation>une bande de {0} % ne suffit pas : dans la paroi {1} de {2} couches tournent de plus de {3} deg/mm, d&apos;abord la couche {4}, jusqu&apos;à {5} deg/mm ailleurs. Le robot y ralentit ; un strategy.band plus large les arrondit</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/walls/beads.py"/>
        <source>a band of {0} % does not suffice: within the wall {1} of {2} layers turn by more than {3} deg/mm, first layer {4}, by up to {5} deg/mm. The robot slows down there; a wider strategy.band rounds them</source>
        <translation>une bande de {0} % ne suffit pas : dans la paroi {1} de {2} couches tournent de plus de {3} deg/mm, d&apos;abord la couche {4}, jusqu&apos;à {5} deg/mm. Le robot y ralentit ; un strategy.band plus large les arrondit</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/walls/beads.py"/>
        <source>a band of {0} % does not suffice: within the wall {1} of {2} layers turn by more than {3} deg/mm, {4} of them in corners, first layer {5}, by up to {6} deg/mm elsewhere. The robot slows down there; a wider strategy.band rounds them</source>
        <translation>une bande de {0} % ne suffit pas : dans la paroi {1} de {2} couches tournent de plus de {3} deg/mm, dont {4} à des angles, d&apos;abord la couche {5}, jusqu&apos;à {6} deg/mm ailleurs. Le robot y ralentit ; un strategy.band plus large les arrondit</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/walls/beads.py"/>
        <source>a band of {0} % does not suffice: within the wall {1} of {2} layers turn by more than {3} deg/mm, {4} of them in corners, first layer {5}, by up to {6} deg/mm. The robot slows down there; a wider strategy.band rounds them</source>
        <translation>une bande de {0} % ne suffit pas : dans la paroi {1} de {2} couches tournent de plus de {3} deg/mm, dont {4} à des angles, d&apos;abord la couche {5}, jusqu&apos;à {6} deg/mm. Le robot y ralentit ; un strategy.band plus large les arrondit</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/slicing/tubes/smooth_spacing.py"/>
        <source>a band of {0} % is too narrow for {1} points around: use more of them</source>
        <translation>une bande de {0} % est trop étroite pour {1} points sur le tour : prenez-en davantage</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/curves/curve_table.py"/>
        <source>a bead of one point has no way to go; give it two points or more</source>
        <translation>un cordon d&apos;un seul point n&apos;a pas de chemin ; donnez-lui deux points ou plus</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/curves.py"/>
        <source>a bead runs along the direction in which it is laid, at {0}: the nozzle would be in its own way; give another strategy.direction, faces, or directions in the table</source>
        <translation>un cordon suit la direction dans laquelle il est déposé, en {0} : la buse se gênerait elle-même ; donnez une autre strategy.direction, des faces, ou des directions dans le tableau</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/slicing/directions/wall.py"/>
        <source>a build direction of {0} is normal to its plane of symmetry; use local</source>
        <translation>une direction de dépôt de {0} est normale à son plan de symétrie ; utilisez local</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/cell.py"/>
        <source>a calibration is that of a machine; write machine: {{name: ur-ur10e, calibration: my_robot.yaml}}</source>
        <translation>un étalonnage est celui d&apos;une machine ; écrivez machine: {{name: ur-ur10e, calibration: my_robot.yaml}}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/placement/moved.py"/>
        <source>a cell with {0} has no {1} that places the part; use {2}</source>
        <translation>une cellule avec {0} n&apos;a pas de {1} qui place la pièce ; utilisez {2}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/shapes/chosen.py"/>
        <source>a circle</source>
        <translation>un cercle</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/linuxcnc/read.py"/>
        <source>a comment that may be carried out, or a line that is too long</source>
        <translation>un commentaire qui peut être exécuté, ou une ligne trop longue</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/shapes/chosen.py"/>
        <source>a cone</source>
        <translation>un cône</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/mesh_file.py"/>
        <source>a coordinate of its vertices is not a number; export it again</source>
        <translation>une coordonnée de ses sommets n&apos;est pas un nombre ; exportez-le de nouveau</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/read_process.py"/>
        <source>a corner has no end from which the time of a trigger counts</source>
        <translation>un coin n&apos;a pas de fin d&apos;où compterait le temps d&apos;un déclencheur</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/curves.py"/>
        <source>a curve is {0} mm off the faces whose normals it is to have, at {1}; choose the faces that it lies on, or give strategy.direction</source>
        <translation>une courbe est à {0} mm des faces dont elle doit avoir les normales, en {1} ; choisissez les faces sur lesquelles elle repose, ou donnez strategy.direction</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/layers/curved/field.py"/>
        <source>a curved layer cannot be laid flat without distortion: beads are up to {0} % nearer together or farther apart than the bead spacing</source>
        <translation>une couche courbe ne se met pas à plat sans distorsion : des cordons sont jusqu&apos;à {0} % plus proches ou plus éloignés que le pas des cordons</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/shapes/chosen.py"/>
        <source>a cylinder</source>
        <translation>un cylindre</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/shapes/chosen.py"/>
        <source>a free-form curve</source>
        <translation>une courbe de forme libre</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/shapes/chosen.py"/>
        <source>a free-form surface</source>
        <translation>une surface de forme libre</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/walls/front_tree.py"/>
        <source>a front splits in {0} at layer {1}</source>
        <translation>un front se divise en {0} à la couche {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/revolution/wall.py"/>
        <source>a gap of {0} mm between faces of {1} is bridged</source>
        <translation>un jour de {0} mm entre des faces de {1} est comblé</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>a height alone is not a cone; give the radius of its base circle too, or base: auto</source>
        <translation>une hauteur seule n&apos;est pas un cône ; donnez aussi le rayon de son cercle de base, ou base: auto</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/tree.py"/>
        <source>a key must be a word (line {0}); write one before the colon</source>
        <translation>une clé doit être un mot (ligne {0}) ; écrivez-en un devant les deux-points</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/solids/filling.py"/>
        <source>a layer all the way round the hub is filled with {0}; strategy.fill = {1} is for regions with an end</source>
        <translation>une couche sur tout le tour du moyeu est remplie de {0} ; strategy.fill = {1} est pour les régions qui ont une fin</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/slicing/tubes/iso_parameter.py"/>
        <source>a layer height of {0} mm is more than the wall&apos;s bend allows; lower it</source>
        <translation>une hauteur de couche de {0} mm est plus que ne permet le coude de la paroi ; réduisez-la</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/fields/rows.py"/>
        <source>a length such as 1 mm</source>
        <translation>une longueur comme 1 mm</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/developable_feature.py"/>
        <source>a mesh has no cylinders and cones; give strategy.base, or a solid part as substrate</source>
        <translation>un maillage n&apos;a ni cylindres ni cônes ; donnez strategy.base, ou une pièce solide comme substrat</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/files/read.py"/>
        <source>a mesh has no exact surfaces; give a part of revolution as STEP, IGES or BREP</source>
        <translation>un maillage n&apos;a pas de surfaces exactes ; donnez une pièce de révolution en STEP, IGES ou BREP</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/cladding_feature.py"/>
        <source>a mesh has no faces to choose; leave them out</source>
        <translation>un maillage n&apos;a pas de faces à choisir ; omettez-les</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/process.py"/>
        <source>a module would have more than {0} speeds, each of which is data of its own here; use fewer speeds, or a smaller program.max_points</source>
        <translation>un module aurait plus de {0} vitesses, dont chacune est une donnée à part ici ; utilisez moins de vitesses, ou un program.max_points plus petit</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/linuxcnc/read.py"/>
        <source>a move before G1, G21, G90 and a work offset are said</source>
        <translation>un mouvement avant que G1, G21, G90 et un décalage d&apos;origine soient dits</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/siemens/read.py"/>
        <source>a move before G1, G90 and G710 are said</source>
        <translation>un mouvement avant que G1, G90 et G710 soient dits</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/kuka/read.py"/>
        <source>a move of ArcTech is a linear one that stops, behind all the lines that belong to it</source>
        <translation>un mouvement d&apos;ArcTech est linéaire et s&apos;arrête, derrière toutes les lignes qui en font partie</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/nc/numbers.py"/>
        <source>a move of {0} s cannot be written; moves take {1} to {2} s: use another speed or a larger chord error</source>
        <translation>un mouvement de {0} s ne peut pas être écrit ; les mouvements prennent de {1} à {2} s : utilisez une autre vitesse ou une plus grande erreur de corde</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/fanuc/numbers.py"/>
        <source>a move of {0} s is longer than {1} s; raise the speed or add points</source>
        <translation>un mouvement de {0} s est plus long que {1} s ; augmentez la vitesse ou ajoutez des points</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/ur/numbers.py"/>
        <source>a move takes {0} ms, less than the {1} ms in which the controller steps; use a larger strategy.chord_error or a lower process.travel_speed</source>
        <translation>un mouvement dure {0} ms, moins que le pas de {1} ms de la commande ; utilisez un strategy.chord_error plus grand ou un process.travel_speed plus petit</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/numbers.py"/>
        <source>a move takes {0} s, less than the {1} s that can be written; use a larger chord error or a lower speed</source>
        <translation>un mouvement prend {0} s, moins que les {1} s qui peuvent s&apos;écrire ; prenez une erreur de corde plus grande ou une vitesse plus faible</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/nc/read.py"/>
        <source>a move without a feed of its own</source>
        <translation>un mouvement sans avance à lui</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/staubli/numbers.py"/>
        <source>a move would need {0} % of the largest joint speed, which cannot be written; use another speed, so that it is {1} to 100 %</source>
        <translation>un mouvement demanderait {0} % de la plus grande vitesse articulaire, ce qui ne peut pas être écrit ; utilisez une autre vitesse, pour qu&apos;il soit de {1} à 100 %</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/yaskawa/post.py"/>
        <source>a move would need {0} % of the largest joint speed, which is programmed in steps of {1} %; use another speed, so that it is {2} to 100 %</source>
        <translation>un mouvement demanderait {0} % de la plus grande vitesse articulaire, qui se dit par pas de {1} % ; utilisez une autre vitesse, pour qu&apos;il soit de {2} à 100 %</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/quantity.py"/>
        <source>a number without a unit such as 0.1</source>
        <translation>un nombre sans unité comme 0.1</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/ur/read.py"/>
        <source>a part does not end</source>
        <translation>une partie ne finit pas</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/staubli/read.py"/>
        <source>a part is loaded without stopping where it cannot be</source>
        <translation>une partie est chargée sans arrêt là où cela ne se peut pas</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/quantity.py"/>
        <source>a percentage such as 20 %</source>
        <translation>un pourcentage comme 20 %</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/shapes/chosen.py"/>
        <source>a plane</source>
        <translation>un plan</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/staubli/moves.py"/>
        <source>a point of {0} asks for another configuration of the arm</source>
        <translation>un point de {0} demande une autre configuration du bras</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/fields.py"/>
        <source>a pose has six numbers, not {0}; give [x, y, z, RX, RY, RZ]</source>
        <translation>une pose a six nombres, et non {0} ; donnez [x, y, z, RX, RY, RZ]</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/fanuc/read.py"/>
        <source>a position is moved to in another way than it is recorded</source>
        <translation>on va à une position autrement qu&apos;elle n&apos;est enregistrée</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/curves/ada3dp.py"/>
        <source>a position is not a number of at most {0} mm; export it again</source>
        <translation>une position n&apos;est pas un nombre d&apos;au plus {0} mm ; exportez-le à nouveau</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/fanuc/records.py"/>
        <source>a position is recorded twice</source>
        <translation>une position est enregistrée deux fois</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/nc/read.py"/>
        <source>a position needs X Y Z, and a move in axes before it</source>
        <translation>une position demande X Y Z, et un mouvement des axes avant elle</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/yaskawa/post.py"/>
        <source>a position of a station or of base axes has a value for each of them from the first one on; use 1, not {0}</source>
        <translation>une position d&apos;une station ou d&apos;axes de base a une valeur pour chacun d&apos;eux à partir du premier ; utiliser 1, pas {0}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/linuxcnc/read.py"/>
        <source>a position on the part needs G94 and a work offset of its own</source>
        <translation>une position sur la pièce demande G94 et un décalage d&apos;origine à elle</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/linuxcnc/read.py"/>
        <source>a position on the part needs X Y Z and all rotary axes</source>
        <translation>une position sur la pièce demande X Y Z et tous les axes rotatifs</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/names.py"/>
        <source>a program&apos;s name</source>
        <translation>le nom d&apos;un programme</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/poses_page.py"/>
        <source>a quaternion is not all zeros; enter the one that the controller shows</source>
        <translation>un quaternion n&apos;est pas tout à zéro ; saisissez celui que la commande affiche</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/curves/gcode.py"/>
        <source>a radius of {0} mm makes no arc between points {1} mm apart; give I and J</source>
        <translation>un rayon de {0} mm ne fait pas d&apos;arc entre des points distants de {1} mm ; donnez I et J</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/classes.py"/>
        <source>a ramp of {0} mm leads from or to the travel_speed there, and there is none; give it, or leave the ramp out</source>
        <translation>une rampe de {0} mm mène de ou vers travel_speed, qui n&apos;y est pas donnée ; donnez-la, ou omettez la rampe</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/fields.py"/>
        <source>a range has two angles, not {0}; give [smallest, largest]</source>
        <translation>une plage a deux angles, et non {0} ; donnez [le plus petit, le plus grand]</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/fields.py"/>
        <source>a range has two percentages, not {0}; give [smallest, largest]</source>
        <translation>une plage a deux pourcentages, et non {0} ; donnez [le plus petit, le plus grand]</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/kuka/text.py"/>
        <source>a rapid would need {0} % of the largest joint speed, and KRL takes whole percentages from {1} to 100; use another rapid speed</source>
        <translation>un rapide demanderait {0} % de la plus grande vitesse articulaire, et KRL prend des pourcentages entiers de {1} à 100 ; prenez une autre vitesse rapide</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/filling/strips.py"/>
        <source>a region round the hub is nowhere as wide as a bead ({0} mm); choose thin = single, a narrower bead or a margin</source>
        <translation>une région autour du moyeu n&apos;est nulle part aussi large qu&apos;un cordon ({0} mm) ; choisissez thin = single, un cordon plus étroit ou une marge</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/siemens/read.py"/>
        <source>a schedule is sent within a bead</source>
        <translation>un programme de soudage est transmis à l&apos;intérieur d&apos;un cordon</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/fanuc/read.py"/>
        <source>a second U{0} is selected</source>
        <translation>un deuxième U{0} est choisi</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/read_process.py"/>
        <source>a second analogue output follows the speed, or a joint move, or without a deposit</source>
        <translation>une seconde sortie analogique suit la vitesse, ou celle d&apos;un mouvement articulaire, ou sans dépôt</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/nc/read.py"/>
        <source>a second analogue output is set</source>
        <translation>une seconde sortie analogique est réglée</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/columns.py"/>
        <source>a second output is switched</source>
        <translation>une seconde sortie est commandée</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/mesh/orientation.py"/>
        <source>a solid was inside out and was turned</source>
        <translation>un solide était à l’envers et a été retourné</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/solids/notes.py"/>
        <source>a spacing range of {0} to {1}</source>
        <translation>une plage d’écartement de {0} à {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/fields/rows.py"/>
        <source>a speed such as 6 mm/s or 360 mm/min</source>
        <translation>une vitesse comme 6 mm/s ou 360 mm/min</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/shapes/chosen.py"/>
        <source>a sphere</source>
        <translation>une sphère</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/revolution/plan.py"/>
        <source>a spiral has no layers to wait between; use path: layers, a slower process.travel_speed, or leave it out</source>
        <translation>une spirale n&apos;a pas de couches entre lesquelles attendre ; utilisez path: layers, une process.travel_speed plus lente, ou retirez cette clé</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/turns/fit.py"/>
        <source>a spiral turns an axis without end, and this set of limits ends it; use path: layers, or a limit set with an endless axis</source>
        <translation>une spirale tourne un axe sans fin, et ce jeu de limites l&apos;arrête ; utilisez path: layers, ou un jeu de limites à axe sans fin</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/shapes/chosen.py"/>
        <source>a straight line</source>
        <translation>une droite</translation>
    </message>
    <message>
        <location filename="../../freecad_am/read_back/events.py"/>
        <source>a temperature is waited for otherwise</source>
        <translation>une température est attendue autrement</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/fields/rows.py"/>
        <source>a time such as 0.1 s</source>
        <translation>un temps comme 0.1 s</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>a toolpath has no joints yet; choose a joint path</source>
        <translation>une trajectoire d&apos;outil n&apos;a pas encore d&apos;articulations ; choisissez une trajectoire articulaire</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/shapes/chosen.py"/>
        <source>a torus</source>
        <translation>un tore</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/refusals.py"/>
        <source>a track has no name of its own here, it is {0}; leave unit out</source>
        <translation>un rail n&apos;a pas ici de nom à lui, c&apos;est {0} ; laisser unit de côté</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/files/three_mf.py"/>
        <source>a triangle in it has a point with a number of more than 64 bits</source>
        <translation>un triangle y a un point dont le numéro dépasse 64 bits</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/process_data.py"/>
        <source>a trigger is not of the module, or set twice</source>
        <translation>un déclencheur n&apos;est pas du module, ou est défini deux fois</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/read_process.py"/>
        <source>a trigger is not set, or named twice, or the arc burns on</source>
        <translation>un déclencheur n&apos;est pas défini, ou est nommé deux fois, ou l&apos;arc brûle encore</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/fields/rows.py"/>
        <source>a turn per length such as 10 deg/mm</source>
        <translation>une rotation par longueur comme 10 deg/mm</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/checks/placed.py"/>
        <source>a value is an object that was deleted; give a number or a text</source>
        <translation>une valeur est un objet qui a été supprimé ; donnez un nombre ou un texte</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/staubli/files.py"/>
        <source>a value is not a plain number</source>
        <translation>une valeur n&apos;est pas un nombre simple</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/process.py"/>
        <source>a weave is an argument of ArcL, which a dry run does not have; block weld and weave on the controller instead</source>
        <translation>un balayage est un argument de ArcL, qu&apos;une marche à vide n&apos;a pas ; bloquez plutôt soudage et balayage sur la commande</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/process.py"/>
        <source>a weave is an argument of ArcL, which program.schedule.by: arc writes</source>
        <translation>un balayage est un argument de ArcL, que program.schedule.by: arc écrit</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/wall.py"/>
        <source>a whole ring has no end to start from; cut it where it stands on the substrate</source>
        <translation>un anneau entier n&apos;a pas d&apos;extrémité d&apos;où partir ; coupez-le là où il repose sur le substrat</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/revolution/wall.py"/>
        <source>a wire or sketch needs an axis to turn about; give one</source>
        <translation>un fil ou une esquisse demande un axe de rotation ; donnez-en un</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/linuxcnc/post.py"/>
        <source>a work offset of LinuxCNC turns about Z only, and the part leans on the table by RX {0} and RY {1} deg; enter an upright origin, as cell.platform: [{2}, {3}, {4}, 0, 0, {5}], or use `motion: joint`</source>
        <translation>un décalage d&apos;origine de LinuxCNC ne tourne qu&apos;autour de Z, et la pièce penche sur la table de RX {0} et RY {1} deg ; entrez une origine droite, comme cell.platform: [{2}, {3}, {4}, 0, 0, {5}], ou utilisez `motion: joint`</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/files/three_mf.py"/>
        <source>a {0} in {1} has a value that is not a number ({2})</source>
        <translation>un élément {0} de {1} a une valeur qui n&apos;est pas un nombre ({2})</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/files/three_mf.py"/>
        <source>a {0} in {1} lacks {2}</source>
        <translation>il manque {2} à un élément {0} de {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/deposit/balance.py"/>
        <source>about {0} cm3 of beads are laid over others of their layer, {1} % of those of {2}: they come nearer to each other than they are wide, or cross; layers get higher there. Use narrower beads, or leave out what is there twice</source>
        <translation>environ {0} cm3 de cordons sont déposés sur d&apos;autres de leur couche, {1} % de ceux de {2} : ils s&apos;approchent plus que leur largeur, ou se croisent ; les couches y deviennent plus hautes. Prenez des cordons plus étroits, ou omettez ce qui est en double</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/deposit/balance.py"/>
        <source>about {0} cm3 of beads are laid over others of their layer, {1} % of {2}: where lines and their links meet contours, and where room is left for less than a bead; layers get higher there. Use fill: contours, narrower beads, or a wider strategy.gap</source>
        <translation>environ {0} cm3 de cordons sont déposés sur d&apos;autres de leur couche, {1} % de {2} : là où les lignes et leurs liaisons rejoignent les contours, et là où il reste de la place pour moins d&apos;un cordon ; les couches y deviennent plus hautes. Utilisez fill : contours, des cordons plus étroits, ou un strategy.gap plus large</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/deposit/balance.py"/>
        <source>about {0} cm3 of beads lie outside the {1} cm3 of {2}: beads of {3} mm stand out where it is narrower; use narrower beads, or machine it off</source>
        <translation>environ {0} cm3 de cordons sont à côté des {1} cm3 de {2} : des cordons de {3} mm en débordent là où c&apos;est plus étroit ; prenez des cordons plus étroits, ou usinez l&apos;excédent</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/deposit/balance.py"/>
        <source>about {0} cm3 of the {1} cm3 of {2} are not deposited</source>
        <translation>environ {0} cm3 des {1} cm3 de {2} ne sont pas déposés</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/deposit/balance.py"/>
        <source>about {0} of the {1} cm3 of {2} are not deposited</source>
        <translation>environ {0} des {1} cm3 de {2} ne sont pas déposés</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/deposit/balance.py"/>
        <source>about {0} of the {1} cm3 of {2}, all that lies within its hub, are not deposited</source>
        <translation>environ {0} des {1} cm3 de {2}, tout ce qui est à l’intérieur de son moyeu, ne sont pas déposés</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/deposit/balance.py"/>
        <source>about {0} of {1} cm3 of beads lie outside {2}, which is {3} mm thick there, and beads are {4} mm wide; give process.bead_width, or machine it off</source>
        <translation>environ {0} des {1} cm3 de cordons sont à côté de {2}, qui y a {3} mm d’épaisseur, et les cordons ont {4} mm de large ; donnez process.bead_width, ou enlevez-les par usinage</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/size.py"/>
        <source>about {0} points in {1} layers are planned, which takes about {2} min of the processor and {3} GB of memory; a larger strategy.layer_height or strategy.chord_error makes them fewer</source>
        <translation>environ {0} points en {1} couches sont planifiés, ce qui prend environ {2} min de processeur et {3} Go de mémoire ; une plus grande valeur de strategy.layer_height ou de strategy.chord_error en réduit le nombre</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>acceleration</source>
        <translation>accélération</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/poses_page.py"/>
        <source>against link 2</source>
        <translation>par rapport au corps 2</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/poses_page.py"/>
        <source>against the horizontal</source>
        <translation>par rapport à l&apos;horizontale</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>aligned</source>
        <translation>alignés</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/placement/figures.py"/>
        <source>all</source>
        <translation>toutes</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/revolution/turn.py"/>
        <source>all around</source>
        <translation>sur tout le tour</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/model/bead_model.py"/>
        <source>all beads get the same length of wire to each millimetre; measure at least two speeds at one wire feed</source>
        <translation>tous les cordons reçoivent la même longueur de fil par millimètre ; mesurez au moins deux vitesses à une même vitesse de fil</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/model/bead_model.py"/>
        <source>all beads have the {0} {1} {2}</source>
        <translation>tous les cordons ont : {0} {1} {2}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/revolution/wall.py"/>
        <source>all its faces are flat; choose a part, or faces, of revolution</source>
        <translation>toutes ses faces sont planes ; choisissez une pièce, ou des faces, de révolution</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/patch_wall.py"/>
        <source>all of the wall lies on the surface of {0}, as if it were a part of it; give the part that is there before the wall, or none where the wall starts on the platform or from edges</source>
        <translation>toute la paroi est sur la surface de {0}, comme si elle en faisait partie ; donnez la pièce qui est là avant la paroi, ou aucune si la paroi commence sur la plateforme ou à des arêtes</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/roundness.py"/>
        <source>all points lie in one line, which no circle fits; measure further round</source>
        <translation>tous les points sont sur une ligne, à laquelle aucun cercle ne convient ; mesurez plus loin sur le tour</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/roundness.py"/>
        <source>all points lie in one line, which no sphere fits; measure further round</source>
        <translation>tous les points sont sur une ligne, à laquelle aucune sphère ne convient ; mesurez plus loin sur le tour</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/roundness.py"/>
        <source>all points lie in one plane, which no circle fits; measure further round</source>
        <translation>tous les points sont dans un plan, auquel aucun cercle ne convient ; mesurez plus loin sur le tour</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/roundness.py"/>
        <source>all points lie in one plane, which no sphere fits; measure further round</source>
        <translation>tous les points sont dans un plan, auquel aucune sphère ne convient ; mesurez plus loin sur le tour</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/mesh/repair.py"/>
        <source>all triangles of the mesh cancel one another; export it again</source>
        <translation>tous les triangles du maillage s&apos;annulent ; exportez-le à nouveau</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>along</source>
        <translation>le long d&apos;un guide</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/choices.py"/>
        <source>along the axis</source>
        <translation>le long de l&apos;axe</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/choices.py"/>
        <source>along the wall</source>
        <translation>le long de la paroi</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>alternate</source>
        <translation>alterné</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/machine.py"/>
        <source>an acceleration</source>
        <translation>une accélération</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/tree.py"/>
        <source>an alias here stands for itself; write the value out</source>
        <translation>un alias se désigne ici lui-même ; écrivez la valeur en toutes lettres</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/kuka/post.py"/>
        <source>an analogue output that KRL sets between approximated moves is set ahead of the motion</source>
        <translation>une sortie analogique que KRL règle entre des mouvements lissés l&apos;est en avance sur le mouvement</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/fields/rows.py"/>
        <source>an angle such as 30 deg</source>
        <translation>un angle comme 30 deg</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/limits_page.py"/>
        <source>an axis that slides has two ends; enter both</source>
        <translation>un axe de translation a deux bouts ; saisissez les deux</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/program.py"/>
        <source>an earlier version wrote this program, whose rapids were not all checked; recompute the job, and read Migrating in the changelog</source>
        <translation>une version antérieure a écrit ce programme, dont les rapides n’étaient pas tous vérifiés ; recalculez le travail, et lisez Migrating dans le journal des modifications</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/kernel/limits.py"/>
        <source>an edge of the face crosses itself at {0}; draw it without crossings, or divide it there and deposit its parts one after the other</source>
        <translation>une arête de la face se croise elle-même en {0} ; dessinez-la sans croisement, ou divisez-la à cet endroit et déposez ses parties l&apos;une après l&apos;autre</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/files/three_mf.py"/>
        <source>an element of {0} is longer than {1} MB</source>
        <translation>un élément de {0} dépasse {1} Mo</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/shapes/chosen.py"/>
        <source>an ellipse</source>
        <translation>une ellipse</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/stage.py"/>
        <source>an input changed while it was computed; recompute</source>
        <translation>une entrée a changé pendant le calcul ; recalculez</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/fanuc/read.py"/>
        <source>an output is switched too, or the arc burns already, or not yet</source>
        <translation>une sortie est commutée aussi, ou l&apos;arc brûle déjà, ou pas encore</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/kuka/read.py"/>
        <source>an output switches the deposit too, or the arc is lit or ended twice</source>
        <translation>une sortie commute aussi le dépôt, ou l&apos;arc est allumé ou terminé deux fois</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/fanuc/post.py"/>
        <source>analogue inputs are whole numbers, not {0}; change below, gain or zero so that it is one</source>
        <translation>les entrées analogiques sont des nombres entiers, et non {0} ; changez below, gain ou zero pour qu&apos;il en soit un</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/linuxcnc/post.py"/>
        <source>analogue output {0} carries the speed of the wire; use another one for schedules</source>
        <translation>la sortie analogique {0} transmet la vitesse du fil ; prenez-en une autre pour les programmes de soudage</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/joint_path.py"/>
        <source>and {} more</source>
        <translation>et {} autres</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>angle</source>
        <translation>angle</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/field.py"/>
        <source>angle range</source>
        <translation>plage d&apos;angles</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/linuxcnc/read.py"/>
        <source>another analogue input is read than the one that is waited for</source>
        <translation>une autre entrée analogique est lue que celle qui est attendue</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/linuxcnc/read.py"/>
        <source>another program is called within a bead</source>
        <translation>un autre programme est appelé au sein d&apos;un cordon</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/placement/moved.py"/>
        <source>another set-up</source>
        <translation>une autre installation</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/columns.py"/>
        <source>another unit is active than in moves before</source>
        <translation>une autre unité est active que dans les mouvements d&apos;avant</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>arc</source>
        <translation>arc</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/program.py"/>
        <source>arc instructions switch the deposit at times of their own</source>
        <translation>les instructions d&apos;arc commutent le dépôt à leurs propres instants</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>arc-length</source>
        <translation>longueur d&apos;arc</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/curves/gcode.py"/>
        <source>arcs are in the plane of X and Z; let the slicer write arcs in the plane of X and Y, or lines only</source>
        <translation>les arcs sont dans le plan de X et Z ; faites écrire au trancheur des arcs dans le plan de X et Y, ou seulement des lignes</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/curves/gcode.py"/>
        <source>arcs are in the plane of Y and Z; let the slicer write arcs in the plane of X and Y, or lines only</source>
        <translation>les arcs sont dans le plan de Y et Z ; faites écrire au trancheur des arcs dans le plan de X et Y, ou seulement des lignes</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/choices.py"/>
        <source>around the axis</source>
        <translation>autour de l&apos;axe</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>around-axis</source>
        <translation>autour de l&apos;axe</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/refusals.py"/>
        <source>as far as is known controllers weave on linear moves, and these are joint moves</source>
        <translation>les commandes balaient sur des mouvements linéaires, à ce que l&apos;on sait, et ceux-ci sont articulaires</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>as found</source>
        <translation>tel que trouvé</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/solids/notes.py"/>
        <source>as high as their layer is there, {0} to {1} mm</source>
        <translation>la hauteur que leur couche a là, {0} à {1} mm</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/size.py"/>
        <source>as it is this job cannot be carried out; looking for what would make it feasible takes up to {0} min of the processor</source>
        <translation>tel quel, ce travail n&apos;est pas réalisable ; chercher ce qui le rendrait réalisable prend jusqu&apos;à {0} min de processeur</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/pendant.py"/>
        <source>as on the pendant of</source>
        <translation>comme sur le pupitre de</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>as the axes can</source>
        <translation>selon les axes</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/solids/notes.py"/>
        <source>as wide as the room that they have, {0} to {1} mm</source>
        <translation>la largeur de la place qu’ils ont, {0} à {1} mm</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/new_job/panel.py"/>
        <source>as you chose</source>
        <translation>comme vous l&apos;avez choisi</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/surface_patch.py"/>
        <source>at ({0}) it is {1} mm off the spline that stands for it, more than {2} mm; rebuild the face, for instance as a loft or a sweep</source>
        <translation>en ({0}) elle est à {1} mm de la spline qui la représente, plus que {2} mm ; reconstruisez la face, par exemple par lissage ou balayage</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/surface_patch.py"/>
        <source>at ({0}) the face has an edge within itself, of {1} deg; round it, or divide the face there and deposit its parts one after the other</source>
        <translation>en ({0}) la face a une arête en son sein, de {1} deg ; arrondissez-la, ou divisez la face à cet endroit et déposez ses parties l&apos;une après l&apos;autre</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/field.py"/>
        <source>at least {0}</source>
        <translation>au moins {0}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/field.py"/>
        <source>at most {0}</source>
        <translation>au plus {0}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/rapids/findings.py"/>
        <source>at {0} ends of beads the retract of {1} mm would leave limits, reach or condition; it is {2} to {3} mm there, {4} times in another direction than along the tool axis and {5} times with the tool turned</source>
        <translation>à {0} extrémités de cordons le retrait de {1} mm sortirait des limites, de l&apos;atteinte ou du conditionnement ; il y est de {2} à {3} mm, {4} fois dans une autre direction que le long de l&apos;axe de l&apos;outil et {5} fois avec l&apos;outil tourné</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/fit_layers.py"/>
        <source>at {0} of {1} places of layer {2} there are no points of the scan around, the first at {3}; it reaches over {4} mm, the layer over {5} mm: scan all that the layer lies on, or check its unit and fit</source>
        <translation>à {0} des {1} endroits de la couche {2} il n&apos;y a pas de points de la numérisation autour, le premier en {3} ; elle s&apos;étend sur {4} mm, la couche sur {5} mm : numérisez tout ce sur quoi la couche repose, ou vérifiez son unité et son ajustement</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/beads/speeds.py"/>
        <source>at {0} short places, {1} mm in all, the deposit is slowed, here to {2} mm/s, for the axes go no faster; up to {3} mm of the bead more than meant lie there{4}</source>
        <translation>en {0} endroits courts, {1} mm en tout, le dépôt est ralenti, ici à {2} mm/s, car les axes ne vont pas plus vite ; jusqu&apos;à {3} mm de cordon de plus que prévu s&apos;y trouvent{4}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/picking/shape_inputs.py"/>
        <source>auto</source>
        <translation>auto</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/layers/along/centre_line.py"/>
        <source>auto finds no centre line of {0} from where it stands: {1}; choose an edge, a wire or a sketch as guide, or set strategy.direction so that the part stands on one of its ends</source>
        <translation>auto ne trouve pas de ligne médiane de {0} à partir de son appui : {1} ; choisissez une arête, un fil ou une esquisse comme guide, ou réglez strategy.direction pour que la pièce repose sur l&apos;une de ses extrémités</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/inverse/recognition.py"/>
        <source>axes 2 and 3 are not parallel</source>
        <translation>les axes 2 et 3 ne sont pas parallèles</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/inverse/opw_recognition.py"/>
        <source>axes 2 and 3 are not parallel, but {0} deg apart</source>
        <translation>les axes 2 et 3 ne sont pas parallèles, mais à {0} deg l&apos;un de l&apos;autre</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/inverse/opw_recognition.py"/>
        <source>axes 2 and 3 are the same line</source>
        <translation>les axes 2 et 3 sont la même droite</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/linuxcnc/read.py"/>
        <source>axes are moved in another frame than that of the machine</source>
        <translation>des axes sont déplacés dans un autre repère que celui de la machine</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/inverse/recognition.py"/>
        <source>axes that follow each other are the same line</source>
        <translation>deux axes qui se suivent sont la même droite</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/inverse/opw_recognition.py"/>
        <source>axes {0} and {1} are {2} deg apart, not 90 deg</source>
        <translation>les axes {0} et {1} sont à {2} deg l&apos;un de l&apos;autre, et non à 90 deg</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/inspection.py"/>
        <source>axis</source>
        <translation>axe</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/inverse/opw_recognition.py"/>
        <source>axis 1 is not the Z of the base frame</source>
        <translation>l&apos;axe 1 n&apos;est pas le Z du repère de base</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/poses_page.py"/>
        <source>axis 3 is shown {}</source>
        <translation>l&apos;axe 3 est montré {}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/refusals.py"/>
        <source>axis {0} has no limits, but joint values of this controller count every turn up to a limit; use limits that have one for axis {1}</source>
        <translation>l&apos;axe {0} n&apos;a pas de limites, mais les valeurs articulaires de ce contrôleur comptent chaque tour jusqu&apos;à une limite ; utilisez des limites qui en ont une pour l&apos;axe {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/read_back/points.py"/>
        <source>axis {0} is up to {1} {2} from the planned value</source>
        <translation>l&apos;axe {0} est jusqu&apos;à {1} {2} de la valeur planifiée</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/fanuc/numbers.py"/>
        <source>axis {0} stands at {1} deg and its turn number cannot be given reliably in a Cartesian position; use `motion: joint`</source>
        <translation>l&apos;axe {0} se tient à {1} deg et son tour ne peut pas être dit sûrement dans une position cartésienne ; utilisez `motion: joint`</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/turns/locked.py"/>
        <source>axis {0} stands at {1} deg; the tool is up to {2} deg off the direction asked for</source>
        <translation>l&apos;axe {0} se tient à {1} deg ; l&apos;outil s&apos;écarte jusqu&apos;à {2} deg de la direction demandée</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/turns/locked.py"/>
        <source>axis {0} stands at {1} deg; the tool is up to {2} deg off the direction asked for, more than joints.max_residual allows ({3} deg); lock the other axis, elsewhere or none</source>
        <translation>l&apos;axe {0} se tient à {1} deg ; l&apos;outil s&apos;écarte jusqu&apos;à {2} deg de la direction demandée, plus que joints.max_residual ne permet ({3} deg) ; bloquez l&apos;autre axe, ailleurs ou aucun</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/turns/unwrap.py"/>
        <source>axis {0} turns back {1} times between beads, first before layer {2}</source>
        <translation>l&apos;axe {0} revient en arrière {1} fois entre les cordons, d&apos;abord avant la couche {2}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/fanuc/post.py"/>
        <source>axis {0} turns {1} deg in one move; an axis of continuous turn goes less than 180 deg per move: add points, or limit the axis</source>
        <translation>l&apos;axe {0} tourne de {1} deg en un mouvement ; un axe à rotation continue fait moins de 180 deg par mouvement : ajoutez des points, ou limitez l&apos;axe</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/siemens/post.py"/>
        <source>axis {0} turns {1} deg in one move; an axis without end goes less than 180 deg per move: add points, or limit the axis</source>
        <translation>l&apos;axe {0} tourne de {1} deg en un mouvement ; un axe sans fin fait moins de 180 deg par mouvement : ajoutez des points, ou limitez l&apos;axe</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/beads/speeds.py"/>
        <source>axis {0} would move at {1} {2}/s, it can do {3}; {4}</source>
        <translation>l&apos;axe {0} irait à {1} {2}/s, il peut {3} ; {4}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/choices.py"/>
        <source>back</source>
        <translation>arrière</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>back-down-flip</source>
        <translation>arrière-bas-retourné</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>back-down-noflip</source>
        <translation>arrière-bas-non retourné</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>back-up-flip</source>
        <translation>arrière-haut-retourné</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>back-up-noflip</source>
        <translation>arrière-haut-non retourné</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>bead</source>
        <translation>cordon</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/choices.py"/>
        <source>bead width</source>
        <translation>largeur de cordon</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/curves/curve_table.py"/>
        <source>bead {0} begins again; keep the lines of a bead together</source>
        <translation>le cordon {0} recommence ; gardez ensemble les lignes d&apos;un cordon</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/methods/closed_form.py"/>
        <source>bead {0} of {1}</source>
        <translation>cordon {0} de {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/facts.py"/>
        <source>bead {} (0 to {}), {}</source>
        <translation>cordon {} (0 à {}), {}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>bead_width</source>
        <translation>largeur de cordon</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/model/material.py"/>
        <source>beads are laid at {0} to {1} mm/s, and {2} at {3} mm/s or more; change process.travel_speed, process.bead_width or process.classes, or measure beads at these speeds</source>
        <translation>les cordons sont déposés de {0} à {1} mm/s, et {2} à {3} mm/s ou plus ; changez process.travel_speed, process.bead_width ou process.classes, ou mesurez des cordons à ces vitesses</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/model/material.py"/>
        <source>beads are laid at {0} to {1} mm/s, and {2} at {3} to {4} mm/s; change process.travel_speed, process.bead_width or process.classes, or measure beads at these speeds</source>
        <translation>les cordons sont déposés de {0} à {1} mm/s, et {2} de {3} à {4} mm/s ; changez process.travel_speed, process.bead_width ou process.classes, ou mesurez des cordons à ces vitesses</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/model/predicted.py"/>
        <source>beads are predicted {0} to {1} mm high, {2} mm in the mean, at layers of {3} mm; set strategy.layer_height to what the beads make{4}</source>
        <translation>les cordons sont prévus hauts de {0} à {1} mm, {2} mm en moyenne, pour des couches de {3} mm ; réglez strategy.layer_height sur ce que font les cordons{4}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/model/predicted.py"/>
        <source>beads are predicted {0} to {1} mm high, {2} mm in the mean, at layers of {3} mm{4}</source>
        <translation>les cordons sont prévus hauts de {0} à {1} mm, {2} mm en moyenne, pour des couches de {3} mm{4}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/read_back/events.py"/>
        <source>beads are woven otherwise than planned</source>
        <translation>les cordons sont balayés autrement que prévu</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/refusals.py"/>
        <source>beads change their schedule, and as far as is known this controller sets outputs between moves ahead of the motion; give start and end nothing but other speeds, or use another controller</source>
        <translation>les cordons changent de programme de soudage, et ce contrôleur met les sorties entre les mouvements en avance sur le mouvement, autant qu&apos;on sache ; ne donnez à start et end que d&apos;autres vitesses, ou prenez un autre contrôleur</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/model/bead_model.py"/>
        <source>beads get wider with speed (m = {0}); check the table&apos;s columns</source>
        <translation>les cordons s&apos;élargissent avec la vitesse (m = {0}) ; vérifiez les colonnes du tableau</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/solids/filling.py"/>
        <source>beads leave {0} gap(s) open, the widest of {1} mm at {2}; strategy.gap allows {3} mm</source>
        <translation>les cordons laissent {0} jour(s) ouverts, le plus large de {1} mm en {2} ; strategy.gap permet {3} mm</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/program/beads.py"/>
        <source>beads of the class {0} have no schedule, and would be laid by that of the bead before; give process.schedule, or one in process.classes.{1}</source>
        <translation>les cordons de la classe {0} n&apos;ont pas de programme de soudage, et seraient déposés avec celui du cordon précédent ; donnez process.schedule, ou un dans process.classes.{1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/program/beads.py"/>
        <source>beads of the class {0} have no schedule, which arc instructions name; give process.schedule, or one in process.classes.{1}</source>
        <translation>les cordons de la classe {0} n&apos;ont pas de programme de soudage, que les instructions d&apos;arc nomment ; donnez process.schedule, ou un dans process.classes.{1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/solids/filling.py"/>
        <source>beads {0} mm wide (process.bead_width), {1} mm apart, leave stripes of {2} mm open between them; use {3} mm or less, or wider beads</source>
        <translation>des cordons larges de {0} mm (process.bead_width), distants de {1} mm, laissent entre eux des bandes ouvertes de {2} mm ; prenez {3} mm ou moins, ou des cordons plus larges</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/rapids/findings.py"/>
        <source>before {0} beads the rapid way is led round what is in the way of all retracts, by places between</source>
        <translation>avant {0} cordons le déplacement rapide contourne, par des positions intermédiaires, ce qui gêne tous les retraits</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/rapids/findings.py"/>
        <source>before {0} beads the tool is retracted in another direction than along its axis, or turned on the way, to pass clear</source>
        <translation>avant {0} cordons l&apos;outil est retiré dans une autre direction que le long de son axe, ou tourné en chemin, pour passer sans toucher</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/rapids/findings.py"/>
        <source>before {0} beads the tool is withdrawn by up to {1} mm instead of {2} mm to pass clear</source>
        <translation>avant {0} cordons l&apos;outil est retiré jusqu&apos;à {1} mm au lieu de {2} mm pour passer sans toucher</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/clad_faces.py"/>
        <source>behind {0} is the material of {1}; use front, which is outside of it</source>
        <translation>derrière {0} se trouve la matière de {1} ; utilisez front, qui est à l&apos;extérieur</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/inspection.py"/>
        <source>best</source>
        <translation>meilleur</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/colouring.py"/>
        <source>beyond a limit</source>
        <translation>au-delà d&apos;une limite</translation>
    </message>
    <message>
        <location filename="../../freecad_am/plots/deviation.py"/>
        <source>beyond the faces</source>
        <translation>au-delà des faces</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/siemens/read.py"/>
        <source>block numbers do not rise</source>
        <translation>les numéros de bloc ne montent pas</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/siemens/read.py"/>
        <source>blocks with a time are compressed into one, which would take the time of the last</source>
        <translation>des blocs qui disent un temps sont comprimés en un seul, qui prendrait le temps du dernier</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/preferences/page.py"/>
        <source>blue to yellow</source>
        <translation>bleu à jaune</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/placement/form.py"/>
        <source>blue {:.4g} … yellow {:.4g}; grey: not feasible</source>
        <translation>bleu {:.4g} … jaune {:.4g} ; gris : pas réalisable</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/inspection.py"/>
        <source>both</source>
        <translation>les deux</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/first_layer.py"/>
        <source>both ends of the wall lie in {0}; let one of them end outside of it</source>
        <translation>les deux extrémités de la paroi sont dans {0} ; faites finir l&apos;une d&apos;elles en dehors</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/inspection.py"/>
        <source>both sides of a wall have a thickness between; give it</source>
        <translation>entre les deux côtés d&apos;une paroi il y a une épaisseur ; donnez-la</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>bottom</source>
        <translation>bas</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/plan.py"/>
        <source>bounding the objective</source>
        <translation>encadrement de l’objectif</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/walls/fronts.py"/>
        <source>build directions</source>
        <translation>directions de dépôt</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/slicing/directions/wall.py"/>
        <source>build directions cannot be brought below {0} deg/mm on a bead of {1} mm: allow a faster turn, or use the mode fixed</source>
        <translation>les directions de dépôt ne peuvent pas être ramenées sous {0} deg/mm sur un cordon de {1} mm : permettez une rotation plus rapide, ou utilisez le mode fixed</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/revolution/plan.py"/>
        <source>build directions of {0} layers, keeping the nozzle clear</source>
        <translation>directions de dépôt de {0} couches, en tenant la buse éloignée</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/program.py"/>
        <source>building moves and events</source>
        <translation>construction des mouvements et événements</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/joint_path.py"/>
        <source>by {0} touched points the part&apos;s coordinates are at [{1}] mm and deg in the robot&apos;s base; left at the points: {2} mm, {3} mm in the mean of squares</source>
        <translation>d&apos;après {0} points palpés, le repère de la pièce est en [{1}] mm et deg dans la base du robot ; écarts aux points : {2} mm, {3} mm en moyenne quadratique</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>call</source>
        <translation>appel</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/stage.py"/>
        <source>cancelled; recompute</source>
        <translation>annulé ; recalculez</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/calibration.py"/>
        <source>cannot be read as a calibration: {0}; give the file as ur_calibration wrote it</source>
        <translation>ne peut pas être lu comme étalonnage : {0} ; donnez le fichier tel que ur_calibration l&apos;a écrit</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/file.py"/>
        <source>cannot be read as a machine file: {0}; mend that place, or choose another file</source>
        <translation>ne peut pas être lu comme un fichier machine : {0} ; corrigez cet endroit, ou choisissez un autre fichier</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/urdf/elements.py"/>
        <source>cannot be read: {0}; choose a file that can</source>
        <translation>ne peut pas être lu : {0} ; choisissez un fichier qui peut l&apos;être</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>cartesian</source>
        <translation>cartésien</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/cell.py"/>
        <source>cell</source>
        <translation>cellule</translation>
    </message>
    <message>
        <location filename="../../freecad_am/interop/export.py"/>
        <source>cells are written as .yaml; end the name with it</source>
        <translation>les cellules sont écrites en .yaml ; terminez le nom ainsi</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/table.py"/>
        <source>centre</source>
        <translation>centre</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/mesh/solid.py"/>
        <source>check it where it was drawn (Part, Check geometry), and draw those faces again or sew them</source>
        <translation>vérifiez-le là où il a été dessiné (Part, Vérifier la géométrie), et redessinez ou cousez ces faces</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/source_page.py"/>
        <source>choose a URDF file</source>
        <translation>choisissez un fichier URDF</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/inverse/opw_recognition.py"/>
        <source>choose a robot with six that turn; those beside it are `cell.external`</source>
        <translation>choisissez un robot qui en a six rotatifs ; ceux d&apos;à côté sont dans `cell.external`</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/place.py"/>
        <source>clearance</source>
        <translation>distance</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/picking/pick_field.py"/>
        <source>click an object</source>
        <translation>cliquez sur un objet</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/picking/pick_field.py"/>
        <source>click edges</source>
        <translation>cliquez sur des arêtes</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/picking/pick_field.py"/>
        <source>click faces or an object</source>
        <translation>cliquez sur des faces ou un objet</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/new_job/fields.py"/>
        <source>click it</source>
        <translation>cliquez dessus</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/new_job/fields.py"/>
        <source>click it with Ctrl</source>
        <translation>cliquez avec Ctrl</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/picking/pick_field.py"/>
        <source>click objects</source>
        <translation>cliquez sur des objets</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>clockwise</source>
        <translation>sens horaire</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/facts.py"/>
        <source>closed</source>
        <translation>fermé</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/wall.py"/>
        <source>closed, {:.1f} mm</source>
        <translation>fermée, {:.1f} mm</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/joints.py"/>
        <source>closed-form inverse</source>
        <translation>inverse sous forme close</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/colouring.py"/>
        <source>closes a gap</source>
        <translation>comble un jour</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/inspection.py"/>
        <source>cm</source>
        <translation>cm</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/point_file.py"/>
        <source>commas stand between columns and before decimals alike; export it with points as decimal signs, or semicolons between columns</source>
        <translation>des virgules séparent à la fois les colonnes et les décimales ; exportez-le avec des points décimaux, ou des points-virgules entre les colonnes</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/checks/predicted_shape.py"/>
        <source>comparing the predicted deposit with the part</source>
        <translation>comparaison du dépôt prédit avec la pièce</translation>
    </message>
    <message>
        <location filename="../../freecad_am/report/of_document.py"/>
        <source>comparing the spacing of layers</source>
        <translation>comparaison de l&apos;espacement des couches</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/colouring.py"/>
        <source>condition</source>
        <translation>condition</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/findings.py"/>
        <source>condition {0} is below the {1} asked for: too near a singularity</source>
        <translation>la condition {0} est au-dessous de {1} demandés : trop près d&apos;une singularité</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/rapids/findings.py"/>
        <source>condition {0} on a rapid move before or after the bead is below the {1} allowed, and no other height, direction or rotation is farther from a singularity; lower joints.min_condition or move the part in the cell</source>
        <translation>le conditionnement {0} lors d&apos;un mouvement rapide avant ou après le cordon est inférieur aux {1} admis, et aucune autre hauteur, direction ou rotation n&apos;est plus loin d&apos;une singularité ; diminuez joints.min_condition ou déplacez la pièce dans la cellule</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/readout.py"/>
        <source>condition {:.4f}, least {:.4f}</source>
        <translation>condition {:.4f}, minimum {:.4f}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/hub.py"/>
        <source>cone, R {:.4g} mm, half angle {:.4g}°</source>
        <translation>cône, R {:.4g} mm, demi-angle {:.4g}°</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>connected</source>
        <translation>contours reliés</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>constant</source>
        <translation>constante</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/controls.py"/>
        <source>constant RZ</source>
        <translation>RZ constant</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/choices.py"/>
        <source>constant distance</source>
        <translation>distance constante</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>constant-distance</source>
        <translation>distance constante</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/facts.py"/>
        <source>contour</source>
        <translation>contour</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/colouring.py"/>
        <source>contour, or closed</source>
        <translation>contour, ou fermé</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>contours</source>
        <translation>contours</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/regions/region.py"/>
        <source>contours that cross or touch were mended; {0} mm^2 changed</source>
        <translation>des contours qui se croisent ou se touchent ont été réparés ; {0} mm^2 ont changé</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/point_file.py"/>
        <source>coordinates in {0}</source>
        <translation>coordonnées en {0}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/point_file.py"/>
        <source>coordinates in {0}, as the file names no unit</source>
        <translation>coordonnées en {0}, car le fichier ne nomme pas d&apos;unité</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/inverse/opw_recognition.py"/>
        <source>correct its geometry, or choose another machine</source>
        <translation>corrigez sa géométrie, ou choisissez une autre machine</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>counter-clockwise</source>
        <translation>sens antihoraire</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/deposit.py"/>
        <source>cubes of the deposit against wire section x feed x time, or what beads count where no wire is known</source>
        <translation>cubes du dépôt contre section du fil x vitesse x temps, ou ce que comptent les cordons là où aucun fil n&apos;est connu</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/size.py"/>
        <source>curved layers are searched for on a grid of about {0} nodes, which takes about {1} min of the processor; a larger strategy.layer_height, or layers: planes, takes less</source>
        <translation>les couches courbes sont cherchées sur une grille d&apos;environ {0} nœuds, ce qui prend environ {1} min de processeur ; un strategy.layer_height plus grand, ou layers: planes, en prend moins</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/surfaces.py"/>
        <source>curves and cladding plan no surface; compare the points with the part</source>
        <translation>les courbes et le rechargement ne planifient pas de surface ; comparez les points à la pièce</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/checks/predicted_shape.py"/>
        <source>curves have no faces that a deposit could be held against; leave out process.machining_allowance</source>
        <translation>les courbes n&apos;ont pas de faces auxquelles comparer un dépôt ; omettez process.machining_allowance</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/revolution/plan.py"/>
        <source>cutting layers</source>
        <translation>découpe des couches</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/hub.py"/>
        <source>cylinder, R {:.4g} mm</source>
        <translation>cylindre, R {:.4g} mm</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>deposit</source>
        <translation>dépôt</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/payload.py"/>
        <source>deposit and what it grows on, where that is closed, at {0} g/cm3 (process.density), against what {1} carries</source>
        <translation>dépôt et ce sur quoi il repose, dans la mesure où c’est fermé, à {0} g/cm3 (process.density), comparé à ce que {1} porte</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/payload.py"/>
        <source>deposit and what it grows on, where that is closed, at {0} g/cm3 (process.density), against what {1} carries, and its moment about the last axis, as it grows</source>
        <translation>dépôt et ce sur quoi il repose, dans la mesure où c’est fermé, à {0} g/cm3 (process.density), comparé à ce que {1} porte, et son moment autour du dernier axe, à mesure qu’il croît</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>deposited</source>
        <translation>déposé</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/place.py"/>
        <source>deposition-point</source>
        <translation>point de dépôt</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/simulation/wording.py"/>
        <source>deposits</source>
        <translation>dépose</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/inspection/view.py"/>
        <source>deviation</source>
        <translation>écart</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/inspection/histogram.py"/>
        <source>deviation, mm (most: {} points)</source>
        <translation>écart, mm (maximum : {} points)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/near_names.py"/>
        <source>did you mean {0}?</source>
        <translation>vouliez-vous dire {0} ?</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/ur/post.py"/>
        <source>digital inputs are 1 to {0} (1 to 8 are digital_in[0] to [7], 9 to {1} the configurable ones), not {2}; use one of these</source>
        <translation>les entrées numériques vont de 1 à {0} (1 à 8 sont digital_in[0] à [7], 9 à {1} les configurables), pas {2} ; utilisez l&apos;une de celles-ci</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/linuxcnc/post.py"/>
        <source>digital inputs are 1 to {0} (motion.digital-in-00 is number 1), not {1}; use one of these</source>
        <translation>les entrées logiques vont de 1 à {0} (motion.digital-in-00 est le numéro 1), et non {1} ; utilisez l&apos;une de celles-ci</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/ur/post.py"/>
        <source>digital outputs are 1 to {0} (1 to 8 are digital_out[0] to [7], 9 to {1} the configurable ones), not {2}; use one of these</source>
        <translation>les sorties numériques vont de 1 à {0} (1 à 8 sont digital_out[0] à [7], 9 à {1} les configurables), pas {2} ; utilisez l&apos;une de celles-ci</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/linuxcnc/post.py"/>
        <source>digital outputs are 1 to {0} (motion.digital-out-00 is number 1), not {1}; use one of these</source>
        <translation>les sorties logiques vont de 1 à {0} (motion.digital-out-00 est le numéro 1), et non {1} ; utilisez l&apos;une de celles-ci</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/yaskawa/post.py"/>
        <source>digital outputs are 1 to {0}, not {1}; use one of these</source>
        <translation>les sorties numériques vont de 1 à {0}, pas {1} ; utilisez l&apos;une d&apos;elles</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/curves/gcode.py"/>
        <source>direct moves of steppers are not known; let the slicer write G1</source>
        <translation>les mouvements directs des moteurs pas à pas ne sont pas connus ; faites écrire G1 par le trancheur</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>displacement</source>
        <translation>déplacement</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/deposit.py"/>
        <source>distance in space of each point to the layer below, against what the strategy allows</source>
        <translation>distance dans l’espace de chaque point à la couche du dessous, comparée à ce que permet la stratégie</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/deposit.py"/>
        <source>distance of {0} places of the beads to the shape itself, less what a scan moved their layers</source>
        <translation>distance de {0} endroits des cordons à la forme elle-même, moins ce dont un scan a déplacé leurs couches</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/deposit.py"/>
        <source>distance of {0} places of the beads to the shape itself, which slicing does not use</source>
        <translation>distance de {0} endroits des cordons à la forme elle-même, que le tranchage n’emploie pas</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/choices.py"/>
        <source>down</source>
        <translation>bas</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/mesh/solid.py"/>
        <source>draw it apart there, or let it overlap there and fuse it (Part, Boolean)</source>
        <translation>écartez-le à cet endroit, ou faites-le s’y recouvrir et fusionnez-le (Part, Booléen)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/report/of_document.py"/>
        <source>drawing the page</source>
        <translation>dessin de la page</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>drift</source>
        <translation>dérive</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/program.py"/>
        <source>dry run, nothing is deposited</source>
        <translation>marche à vide, rien n&apos;est déposé</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/deposit.py"/>
        <source>each short piece of a bead, against its build direction, over earlier deposit as wide as it is and what is there</source>
        <translation>chaque court morceau de cordon, contre sa direction de dépôt, sur le dépôt précédent de sa largeur et ce qui est là</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/proposed_family.py"/>
        <source>edges of {0} are chosen, which are laid as beads</source>
        <translation>des arêtes de {0} sont choisies, qui sont déposées comme cordons</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/legend.py"/>
        <source>en</source>
        <translation>fr</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/limits_page.py"/>
        <source>enter speed, acceleration and jerk of more than 0, or leave them empty</source>
        <translation>saisissez une vitesse, une accélération et un jerk supérieurs à 0, ou laissez-les vides</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/urdf/elements.py"/>
        <source>entities such as {0} are not read; write out what they stand for</source>
        <translation>les entités comme {0} ne sont pas lues ; écrivez ce qu&apos;elles représentent</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/staleness.py"/>
        <source>error</source>
        <translation>erreur</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/joints.py"/>
        <source>every point of the motion, rapids included, against the machine file</source>
        <translation>chaque point du mouvement, rapides compris, comparé au fichier machine</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/kuka/read.py"/>
        <source>external axes do not run at {0} % of their speeds</source>
        <translation>les axes externes ne tournent pas à {0} % de leurs vitesses</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/columns.py"/>
        <source>external axes have no value, or their unit is not active, or not the object&apos;s</source>
        <translation>des axes externes n&apos;ont pas de valeur, ou leur unité n&apos;est pas active, ou n&apos;est pas celle de l&apos;objet</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/columns.py"/>
        <source>external axes would move where it stands</source>
        <translation>des axes externes bougeraient là où il est à l&apos;arrêt</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/mesh/solid.py"/>
        <source>faces of the solid do not meet along their edges</source>
        <translation>des faces du solide ne se joignent pas le long de leurs arêtes</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/mesh/triangle_mesh.py"/>
        <source>faces of the wall&apos;s mesh turn opposite ways: orient the faces alike</source>
        <translation>des faces du maillage de la paroi sont tournées en sens opposés : orientez-les pareillement</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/proposed_family.py"/>
        <source>faces of {0} are chosen, which do not turn about one axis, and it is thicker there than a bead of {1} mm, so they are covered</source>
        <translation>des faces de {0} sont choisies, qui ne tournent pas autour d&apos;un axe, et elle y est plus épaisse qu&apos;un cordon de {1} mm, elles sont donc recouvertes</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/proposed_family.py"/>
        <source>faces of {0} are chosen, which do not turn about one axis, so they are a wall that starts on the platform where nothing carries it</source>
        <translation>des faces de {0} sont choisies, qui ne tournent pas autour d&apos;un axe : c&apos;est une paroi qui part du plateau là où rien ne la porte</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/proposed_family.py"/>
        <source>faces of {0} are chosen, which do not turn about one axis, so they are a wall; it needs a substrate, or edges to start from</source>
        <translation>des faces de {0} sont choisies, qui ne tournent pas autour d&apos;un axe : c&apos;est une paroi ; il lui faut un substrat, ou des arêtes d&apos;où partir</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/cladding.py"/>
        <source>faces that are bent both ways cannot be laid flat without distortion: beads are up to {0} % nearer together or farther apart than the bead spacing; strategy.distortion bounds that</source>
        <translation>les faces courbées dans les deux sens ne peuvent pas être mises à plat sans déformation : les cordons sont jusqu&apos;à {0} % plus proches ou plus éloignés que l&apos;espacement des cordons ; strategy.distortion le limite</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/size.py"/>
        <source>facets meet at sharp angles along about {0} mm of edges; finding layers around these takes about {1} min of the processor; a larger strategy.layer_height, or a mesh with rounded edges, takes less</source>
        <translation>des facettes se rejoignent à angle vif le long d&apos;environ {0} mm d&apos;arêtes ; y trouver les couches prend environ {1} min de processeur ; un strategy.layer_height plus grand, ou un maillage aux arêtes arrondies, en prend moins</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/staleness.py"/>
        <source>failed</source>
        <translation>échoué</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/colouring.py"/>
        <source>faster than it can</source>
        <translation>plus vite qu&apos;elle ne peut</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>feature</source>
        <translation>élément à déposer</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/mesh/solid.py"/>
        <source>fill holes (Mesh, Close holes) or export it again</source>
        <translation>bouchez les trous (Mesh, Fermer les trous) ou exportez-le de nouveau</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/colouring.py"/>
        <source>fill, or open</source>
        <translation>remplissage, ou ouvert</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/slicing/fronts/layers.py"/>
        <source>finding layer {0}</source>
        <translation>recherche de la couche {0}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/walls/plan.py"/>
        <source>finding layers</source>
        <translation>recherche des couches</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>first</source>
        <translation>premier</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/colouring.py"/>
        <source>first layer</source>
        <translation>première couche</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/solid.py"/>
        <source>first layer: 1 contour</source>
        <translation>première couche : 1 contour</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/solid.py"/>
        <source>first layer: {} contours</source>
        <translation>première couche : {} contours</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/hub.py"/>
        <source>first layer: {} contours, {:.1f} mm</source>
        <translation>première couche : {} contours, {:.1f} mm</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/choices.py"/>
        <source>five-axis machine</source>
        <translation>machine à cinq axes</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/build_direction.py"/>
        <source>fixed</source>
        <translation>fixe</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/choices.py"/>
        <source>flip</source>
        <translation>retourné</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/methods/constant.py"/>
        <source>following the beads</source>
        <translation>suivi des cordons</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/catalogue.py"/>
        <source>freecad-am machines</source>
        <translation>freecad-am machines</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/revolution/tilt.py"/>
        <source>from layer {0} on, directions are tilted back to keep the nozzle clear, by up to {1} deg in layer {2}</source>
        <translation>à partir de la couche {0}, les directions sont redressées pour tenir la buse éloignée, jusqu&apos;à {1} deg dans la couche {2}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/revolution/tilt.py"/>
        <source>from layer {0} on, max_tilt holds directions within {1} deg</source>
        <translation>à partir de la couche {0}, max_tilt tient les directions à {1} deg au plus</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/revolution/turn.py"/>
        <source>from {0} to {1} deg</source>
        <translation>de {0} à {1} deg</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/choices.py"/>
        <source>front</source>
        <translation>avant</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>front-down-flip</source>
        <translation>avant-bas-retourné</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>front-down-noflip</source>
        <translation>avant-bas-non retourné</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>front-up-flip</source>
        <translation>avant-haut-retourné</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>front-up-noflip</source>
        <translation>avant-haut-non retourné</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>fronts</source>
        <translation>fronts</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>fronts follow no lines of a surface, as iso-parameter layers do; leave strategy.method out, or use constant-distance or smooth</source>
        <translation>les fronts ne suivent pas les lignes d&apos;une surface comme le font les couches iso-parameter ; retirez strategy.method, ou utilisez constant-distance ou smooth</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>geodesic</source>
        <translation>géodésique</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/cell.py"/>
        <source>give a list such as - {{file: table.step, pose: [0, 0, -200, 0, 0, 0]}}</source>
        <translation>donnez une liste comme - {{file: table.step, pose: [0, 0, -200, 0, 0, 0]}}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/cell.py"/>
        <source>give a list such as - {{machine: motoman-motopos-d500, pose: [1500, 0, 0, 0, 0, 0], carries: part}}</source>
        <translation>donnez une liste comme - {{machine: motoman-motopos-d500, pose: [1500, 0, 0, 0, 0, 0], carries: part}}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/cell.py"/>
        <source>give a list such as - {{part: [0, 0, 0], robot: [900.4, 2.1, -99.7]}}</source>
        <translation>donnez une liste comme - {{part: [0, 0, 0], robot: [900.4, 2.1, -99.7]}}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/quantity.py"/>
        <source>give a quantity in {0}</source>
        <translation>donnez une grandeur en {0}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/curves/curve_table.py"/>
        <source>give a table of the columns x,y,z, then i,j,k where directions are given, then bead where there are several</source>
        <translation>donnez un tableau des colonnes x,y,z, puis i,j,k si des directions sont données, puis bead s&apos;il y en a plusieurs</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/curves/gcode.py"/>
        <source>give absolute or relative moves in mm, G0 to G3 with E, as a slicer for filament or pellets writes them</source>
        <translation>donnez des mouvements absolus ou relatifs en mm, G0 à G3 avec E, comme les écrit un trancheur pour filament ou granulés</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/limits_page.py"/>
        <source>give both ends of its range, or none for an endless axis</source>
        <translation>donnez les deux bouts de sa plage, ou aucun pour un axe sans fin</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/links/bodies.py"/>
        <source>give sizes larger than 0: of a box along x, y and z, of a cylinder its diameter and length</source>
        <translation>donnez des dimensions supérieures à 0 : d&apos;un pavé selon x, y et z, d&apos;un cylindre son diamètre et sa longueur</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/inverse/opw_recognition.py"/>
        <source>give the geometry with more digits</source>
        <translation>donnez la géométrie avec plus de chiffres</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/frames_page.py"/>
        <source>give the lower end first, or leave both empty</source>
        <translation>donnez d&apos;abord la valeur basse, ou laissez les deux vides</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>give three numbers such as [0, 0, 1]</source>
        <translation>donnez trois nombres comme [0, 0, 1]</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>give three numbers such as [0, 0, 1], or auto</source>
        <translation>donnez trois nombres comme [0, 0, 1], ou auto</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/methods/point_by_point.py"/>
        <source>going from point to point</source>
        <translation>passage de point en point</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/preferences/page.py"/>
        <source>grey</source>
        <translation>gris</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>grid</source>
        <translation>grille</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>gyroid</source>
        <translation>gyroïde</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/sheet.py"/>
        <source>halving the edges of the mesh of the wall down to {0} mm, by layer height and smallest radius, comes to no end, though about {1} triangles would do, as where a face is twisted like that of a coil; make it of shorter faces, or deposit the wall in parts or as a solid</source>
        <translation>diviser par deux les arêtes du maillage de la paroi jusqu&apos;à {0} mm, d&apos;après la hauteur de couche et le plus petit rayon, n&apos;a pas de fin, alors qu&apos;environ {1} triangles suffiraient, comme là où une face est tordue, telle celle d&apos;un ressort ; faites-la de faces plus courtes, ou déposez la paroi par parties ou comme un solide</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>height</source>
        <translation>hauteur</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/deposit.py"/>
        <source>height of each point over the nearest place of the layer below, along the build direction there</source>
        <translation>hauteur de chaque point au-dessus de l’endroit le plus proche de la couche inférieure, selon la direction de dépôt à cet endroit</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>highest</source>
        <translation>la plus haute</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>honeycomb</source>
        <translation>nid d&apos;abeilles</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/yaskawa/post.py"/>
        <source>how a job waits for an analogue input differs with the controller&apos;s options, and the post yaskawa knows none</source>
        <translation>la façon dont un job attend une entrée analogique dépend des options de la commande, et le post-processeur yaskawa n&apos;en connaît aucune</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/yaskawa/post.py"/>
        <source>how an INFORM job switches an output ahead of a place was not confirmed</source>
        <translation>la façon dont un programme INFORM commute une sortie avant un lieu n&apos;a pas été confirmée</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/deposit.py"/>
        <source>how far a deposit of cubes of {0} mm, filled bead by bead with what the wire feeds, reaches beyond {1} places of the part&apos;s faces, along their normals</source>
        <translation>de combien un dépôt de cubes de {0} mm, remplis cordon par cordon de ce que le fil apporte, dépasse {1} endroits des faces de la pièce, le long de leurs normales</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/checks/controllers.py"/>
        <source>how many pulses {0} counts to a degree of each axis is not known, and no two models are alike; make a machine file of your own of it, with controller.pulses_per_degree as the pendant shows them (a position in pulses over the same in degrees), or plan without a program</source>
        <translation>combien d&apos;impulsions {0} compte par degré de chaque axe n&apos;est pas connu, et deux modèles diffèrent toujours ; faites-en un fichier machine à vous, avec controller.pulses_per_degree d&apos;après le pupitre (une position en impulsions divisée par la même en degrés), ou planifiez sans programme</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/revolution/tilt.py"/>
        <source>however far it is tilted back, the nozzle touches platform or deposit, beads of {0} mm, in {1} layer(s), from layer {2} on; use a slimmer nozzle, another wall, or a smaller process.bead_width where beads are not that wide</source>
        <translation>si fort qu&apos;elle soit redressée, la buse touche le plateau ou le dépôt, des cordons de {0} mm, dans {1} couche(s), à partir de la couche {2} ; utilisez une buse plus fine, une autre paroi, ou un process.bead_width plus petit là où les cordons sont moins larges</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/clearance/notes.py"/>
        <source>however the tool is tilted, the nozzle touches substrate, fixture, platform or deposit at {0} point(s) of layers {1} to {2}</source>
        <translation>quelle que soit l&apos;inclinaison de l&apos;outil, la buse touche le substrat, un montage, la plateforme ou le dépôt en {0} point(s) des couches {1} à {2}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/curves/curve_table.py"/>
        <source>i, j, k are 0; give a direction, such as 0, 0, 1</source>
        <translation>i, j, k sont 0 ; donnez une direction, comme 0, 0, 1</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/clearance/notes.py"/>
        <source>in layer {0}, tool axes are tilted back to keep the nozzle clear, by up to {1} deg</source>
        <translation>dans la couche {0}, les axes de l&apos;outil sont redressés pour tenir la buse éloignée, jusqu&apos;à {1} deg</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/clearance/notes.py"/>
        <source>in layers {0} to {1}, tool axes are tilted back to keep the nozzle clear, by up to {2} deg</source>
        <translation>dans les couches {0} à {1}, les axes de l&apos;outil sont redressés pour tenir la buse éloignée, jusqu&apos;à {2} deg</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/colouring.py"/>
        <source>in the middle</source>
        <translation>au milieu</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/inspection.py"/>
        <source>inch</source>
        <translation>pouce</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/staleness.py"/>
        <source>infeasible</source>
        <translation>infaisable</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>inner</source>
        <translation>intérieure</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/inspection.py"/>
        <source>inspection</source>
        <translation>contrôle</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/joints.py"/>
        <source>inverse condition number of the Jacobian at the points of the deposit, against the least one allowed</source>
        <translation>inverse du conditionnement de la jacobienne aux points du dépôt, comparé au minimum permis</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/quantity.py"/>
        <source>is a length</source>
        <translation>est une longueur</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/quantity.py"/>
        <source>is a speed</source>
        <translation>est une vitesse</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/quantity.py"/>
        <source>is a time</source>
        <translation>est un temps</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/quantity.py"/>
        <source>is a turn per length</source>
        <translation>est une rotation par longueur</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/quantity.py"/>
        <source>is an angle</source>
        <translation>est un angle</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/quantity.py"/>
        <source>is of another dimension</source>
        <translation>est d&apos;une autre dimension</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/quantity.py"/>
        <source>is without unit</source>
        <translation>est sans unité</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>iso-height</source>
        <translation>hauteur constante</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>iso-parameter</source>
        <translation>paramètre constant</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/slicing/solids/overlap.py"/>
        <source>it and {0} fill the same place, as at {1}, which would be deposited twice; fuse them into one solid, or move one</source>
        <translation>lui et {0} remplissent le même endroit, comme en {1}, qui serait déposé deux fois ; fusionnez-les en un solide, ou déplacez-en un</translation>
    </message>
    <message>
        <location filename="../../freecad_am/read_back/followed.py"/>
        <source>it begins with a position and names no configuration of the arm; say it in the cell, branch: [front, up, flip]</source>
        <translation>il commence par une position et ne nomme aucune configuration du bras ; indiquez-la dans la cellule, branch: [front, up, flip]</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/files/three_mf.py"/>
        <source>it builds more than holds itself; simplify it</source>
        <translation>il construit plus que ce qui se contient soi-même ; simplifiez-le</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/files/three_mf.py"/>
        <source>it builds more than is not in it; simplify it</source>
        <translation>il construit plus que ce qui n&apos;y est pas ; simplifiez-le</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/files/three_mf.py"/>
        <source>it builds more than {0} objects, or objects nested {1} times; simplify it</source>
        <translation>il construit plus de {0} objets, ou des objets imbriqués {1} fois ; simplifiez-le</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/files/three_mf.py"/>
        <source>it builds more than {0} points; simplify it</source>
        <translation>il construit plus de {0} points ; simplifiez-le</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/files/three_mf.py"/>
        <source>it builds more than {0} triangles; simplify it</source>
        <translation>il construit plus de {0} triangles ; simplifiez-le</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/files/three_mf.py"/>
        <source>it builds no triangles; export the part again</source>
        <translation>il ne construit pas de triangles ; exportez la pièce de nouveau</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/fanuc/read.py"/>
        <source>it calls itself</source>
        <translation>il s&apos;appelle lui-même</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/scan_motion.py"/>
        <source>it cannot be laid onto {0}: {1}</source>
        <translation>elle ne peut pas être ramenée sur {0} : {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/shapes/document_file.py"/>
        <source>it cannot be read as a FreeCAD document; save it again</source>
        <translation>il ne peut pas être lu comme un document FreeCAD ; enregistrez-le de nouveau</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/files/read.py"/>
        <source>it cannot be read: {0}; choose a file that can</source>
        <translation>il ne peut pas être lu : {0} ; choisissez un fichier qui peut l&apos;être</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/user_machines.py"/>
        <source>it cannot be written: {0}; check the folder</source>
        <translation>il ne peut pas être écrit : {0} ; vérifiez le dossier</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/fields/settings.py"/>
        <source>it cannot follow an expression; give a plain value</source>
        <translation>il ne peut pas suivre une expression ; donnez une valeur simple</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/wall.py"/>
        <source>it closes on itself both ways; choose a tube that is closed around</source>
        <translation>elle se ferme sur elle-même dans les deux sens ; choisissez un tube fermé sur son tour</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/layers/along/guide_edges.py"/>
        <source>it comes back to where it begins, at {0}: the last layer would lie on the first; leave an edge of it out</source>
        <translation>il revient à son début, en {0} : la dernière couche reposerait sur la première ; enlevez-en une arête</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/beads/speeds.py"/>
        <source>it could at {0} mm/s, but the bead model asks for {1} mm/s and too much would pile up: turn the torch more slowly (build_direction.max_turn), lean it less, mount the part otherwise, or ask for a wider bead (process.bead_width), which is laid more slowly</source>
        <translation>il le pourrait à {0} mm/s, mais le modèle de cordon demande {1} mm/s et trop s&apos;y amasserait : tournez la torche plus lentement (build_direction.max_turn), penchez-la moins, montez la pièce autrement, ou demandez un cordon plus large (process.bead_width), qui est posé plus lentement</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/revolution/wire.py"/>
        <source>it crosses the axis by {0} mm; keep it on one side</source>
        <translation>il croise l&apos;axe de {0} mm ; gardez-le d&apos;un seul côté</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/mesh/solid.py"/>
        <source>it cuts itself: {0} pairs of its triangles cross, for instance at {1}, so that what is inside is not known; fuse what overlaps where the part was drawn, or repair the mesh (Mesh, Analyze, Self-intersections)</source>
        <translation>il se coupe lui-même : {0} paires de ses triangles se croisent, par exemple en {1}, de sorte que l&apos;intérieur n&apos;est pas connu ; fusionnez ce qui se recouvre là où la pièce a été dessinée, ou réparez le maillage (Mesh, Analyser, Auto-intersections)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/staubli/files.py"/>
        <source>it declares a document type, which no controller writes</source>
        <translation>il déclare un type de document, ce qu&apos;aucune commande n&apos;écrit</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/staubli/read.py"/>
        <source>it does not end the motion and switch the deposit off</source>
        <translation>il ne termine pas le mouvement et ne coupe pas le dépôt</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/siemens/read.py"/>
        <source>it does not end with M17, or calls itself</source>
        <translation>il ne finit pas par M17, ou s&apos;appelle lui-même</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/siemens/read.py"/>
        <source>it does not end with M30, or calls itself</source>
        <translation>il ne finit pas par M30, ou s&apos;appelle lui-même</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/staubli/files.py"/>
        <source>it does not hold the code of a program {0}</source>
        <translation>il ne contient pas le code d&apos;un programme {0}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/yaskawa/read.py"/>
        <source>it does not say how many pulses there are to a degree of each axis, a mm of a track</source>
        <translation>il ne dit pas combien d&apos;impulsions fait un degré de chaque axe, ou un mm d&apos;un rail</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/yaskawa/read.py"/>
        <source>it does not say what unit V has</source>
        <translation>il ne dit pas quelle unité a V</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/slicing/solids/standing.py"/>
        <source>it does not stand on the hub: it begins {0} mm outside of {1}, at {2}; move it, or choose its base{3}</source>
        <translation>il ne repose pas sur le moyeu : il commence à {0} mm en dehors de {1}, en {2} ; déplacez-le, ou choisissez sa base{3}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/slicing/solids/standing.py"/>
        <source>it does not stand on the hub: it lies inside of the hub; move it, or choose its base{0}</source>
        <translation>il ne repose pas sur le moyeu : il est à l&apos;intérieur du moyeu ; déplacez-le, ou choisissez sa base{0}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/slicing/solids/standing.py"/>
        <source>it does not stand on the hub: it passes {0} beside the face, near {1}; move it, or choose its base{2}</source>
        <translation>il ne repose pas sur le moyeu : il passe à {0} à côté de la face, près de {1} ; déplacez-le, ou choisissez sa base{2}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/revolution/patch.py"/>
        <source>it does not turn about the axis</source>
        <translation>elle ne tourne pas autour de l&apos;axe</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/read.py"/>
        <source>it ends before the last move does</source>
        <translation>il finit avant le dernier mouvement</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/siemens/read.py"/>
        <source>it ends with the deposit on</source>
        <translation>il finit avec le dépôt en marche</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/linuxcnc/read.py"/>
        <source>it ends with the deposit on, or within a loop</source>
        <translation>il finit avec le dépôt en marche, ou dans une boucle</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/siemens/read.py"/>
        <source>it ends within a loop</source>
        <translation>il finit dans une boucle</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/curves/gcode.py"/>
        <source>it extrudes before the program says where: X, Y and Z have to be given first; {0}</source>
        <translation>il extrude avant que le programme ne dise où : X, Y et Z doivent être donnés d&apos;abord ; {0}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/model/bead_model.py"/>
        <source>it has 1 row; measure at least {0} beads</source>
        <translation>il a 1 ligne ; mesurez au moins {0} cordons</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/layers/along/guide_edges.py"/>
        <source>it has a corner of {0} deg at {1}, where layers would have no height on the inside; round it with a radius, or choose guide: auto</source>
        <translation>il a un angle vif de {0} deg en {1}, où les couches n&apos;auraient pas de hauteur à l&apos;intérieur ; arrondissez-le par un rayon, ou choisissez guide: auto</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/files/three_mf.py"/>
        <source>it has a document type, which 3MF does not allow</source>
        <translation>il a un type de document, ce que 3MF ne permet pas</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/wall.py"/>
        <source>it has an edge along its seam, which cannot be deposited yet; make it smooth there</source>
        <translation>elle a une arête le long de sa couture, ce qui ne peut pas encore être déposé ; rendez-la lisse à cet endroit</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/revolution/patch.py"/>
        <source>it has an edge but no area, so the file is damaged or it does not turn about the axis</source>
        <translation>elle a une arête mais pas d&apos;aire, donc le fichier est endommagé ou elle ne tourne pas autour de l&apos;axe</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/first_layer.py"/>
        <source>it has an edge that is neither straight across the tube at its end nor below the first layer, which cannot be deposited yet; fill openings, and cut ends straight</source>
        <translation>elle a une arête qui n&apos;est ni droite en travers du tube à son extrémité ni sous la première couche, ce qui ne peut pas encore être déposé ; comblez les ouvertures, et coupez droit les extrémités</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/names.py"/>
        <source>it has more than {0} characters</source>
        <translation>il a plus de {0} caractères</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/model/bead_table.py"/>
        <source>it has more values than there are columns; write decimals with a point</source>
        <translation>il a plus de valeurs que de colonnes ; écrivez les décimales avec un point</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/revolution/wall.py"/>
        <source>it has neither faces nor edges; choose another object</source>
        <translation>il n&apos;a ni faces ni arêtes ; choisissez un autre objet</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/kuka/read.py"/>
        <source>it has no DEF</source>
        <translation>il n’a pas de DEF</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/linuxcnc/post.py"/>
        <source>it has no arc instructions</source>
        <translation>elle n&apos;a pas d&apos;instructions d&apos;arc</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/wall.py"/>
        <source>it has no closed direction; choose a tube that is closed around</source>
        <translation>elle n&apos;a pas de direction fermée ; choisissez un tube fermé sur son tour</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/model/bead_table.py"/>
        <source>it has no column {0}; name in its first line {1}</source>
        <translation>il n&apos;a pas de colonne {0} ; nommez dans sa première ligne {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/curves.py"/>
        <source>it has no edges to lay as beads; choose edges, a wire or a sketch</source>
        <translation>il n&apos;a pas d&apos;arêtes à déposer en cordons ; choisissez des arêtes, un fil ou une esquisse</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/revolution/wall.py"/>
        <source>it has no face of any width; choose another object</source>
        <translation>il n&apos;a aucune face de quelque largeur ; choisissez un autre objet</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/revolution/wall.py"/>
        <source>it has no face that turns about the axis; name the faces of the wall</source>
        <translation>aucune de ses faces ne tourne autour de l&apos;axe ; nommez les faces de la paroi</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/shapes/distance.py"/>
        <source>it has no faces to compare points with; choose a solid or a surface</source>
        <translation>il n&apos;a pas de face à laquelle comparer les points ; choisissez un solide ou une surface</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/shapes/tessellate.py"/>
        <source>it has no faces to keep the nozzle clear of; choose a solid or a mesh</source>
        <translation>il n&apos;a pas de face dont tenir la buse éloignée ; choisissez un solide ou un maillage</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/wall.py"/>
        <source>it has no faces; choose a part with the faces of the wall</source>
        <translation>il n&apos;a pas de faces ; choisissez une pièce avec les faces de la paroi</translation>
    </message>
    <message>
        <location filename="../../freecad_am/interop/source.py"/>
        <source>it has no path; choose a toolpath, joint path or program</source>
        <translation>il n&apos;a pas de trajectoire ; choisissez une trajectoire d&apos;outil, une trajectoire articulaire ou un programme</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/simulation/run.py"/>
        <source>it has no points to play; choose another path</source>
        <translation>elle n&apos;a pas de points à jouer ; choisissez une autre trajectoire</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/curves/curve_table.py"/>
        <source>it has no points; {0}</source>
        <translation>il n&apos;a pas de points ; {0}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/shapes/bodies.py"/>
        <source>it has no shape; choose an object with a shape</source>
        <translation>il n&apos;a pas de forme ; choisissez un objet qui a une forme</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/hub.py"/>
        <source>it has no solid; choose solids or closed meshes to deposit</source>
        <translation>il n&apos;a pas de solide ; choisissez des solides ou des maillages fermés à déposer</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/curves.py"/>
        <source>it has no {0}, but {1} {2}(s); name others, from {3}1 on</source>
        <translation>il n&apos;a pas de {0}, mais {1} {2}(s) ; nommez-en d&apos;autres, à partir de {3}1</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/guide.py"/>
        <source>it has no {0}; choose from Edge1 to Edge{1}</source>
        <translation>il n&apos;a pas de {0} ; choisissez de Edge1 à Edge{1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/revolution/wall.py"/>
        <source>it has no {0}; choose from Face1 to Face{1}</source>
        <translation>il n&apos;a pas de {0} ; choisissez de Face1 à Face{1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/mesh_wall.py"/>
        <source>it has no {0}; choose from the open ends of the mesh, by height: {1}</source>
        <translation>il n&apos;a pas de {0} ; choisissez parmi les extrémités ouvertes du maillage, par hauteur : {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/revolution/wall.py"/>
        <source>it has only flat faces across the axis; name the faces of the wall</source>
        <translation>il n&apos;a que des faces planes en travers de l&apos;axe ; nommez les faces de la paroi</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/ur/read.py"/>
        <source>it has other characters than ASCII</source>
        <translation>il contient d&apos;autres caractères que l&apos;ASCII</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/kuka/read.py"/>
        <source>it has {0}</source>
        <translation>il a {0}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/inverse/opw_recognition.py"/>
        <source>it has {0} axes, {1} of which slide</source>
        <translation>elle a {0} axes, dont {1} linéaires</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/curves/curve_table.py"/>
        <source>it has {0} columns; {1}</source>
        <translation>il a {0} colonnes ; {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/guide.py"/>
        <source>it has {0} edges, of which a guide takes some; name them, as in edges: [Edge1]</source>
        <translation>il a {0} arêtes, dont un guide prend quelques-unes ; nommez-les, comme dans edges: [Edge1]</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/wall.py"/>
        <source>it has {0} faces that are not flat; name the wall&apos;s in part.faces</source>
        <translation>il a {0} faces qui ne sont pas planes ; nommez celles de la paroi dans part.faces</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/curves/curve_table.py"/>
        <source>it has {0} numbers in place of {1}; fill the gap, or leave the line out</source>
        <translation>elle a {0} nombres au lieu de {1} ; remplissez le vide, ou enlevez la ligne</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/model/bead_model.py"/>
        <source>it has {0} rows; measure at least {1} beads</source>
        <translation>il a {0} lignes ; mesurez au moins {1} cordons</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/toolpath.py"/>
        <source>it holds for the whole program, not for one of its features; give it at the top level</source>
        <translation>cela vaut pour tout le programme, non pour un de ses éléments ; donnez-le au premier niveau</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/files/read.py"/>
        <source>it holds no shape; export the part again</source>
        <translation>il ne contient pas de forme ; exportez la pièce de nouveau</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/files/read.py"/>
        <source>it holds no triangles; export the part again</source>
        <translation>il ne contient pas de triangles ; exportez la pièce de nouveau</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/walls/clad_mesh.py"/>
        <source>it is a closed mesh, which has no faces to choose; cut out of it what is to be covered (Mesh, Cutting), or take the file that it was made of</source>
        <translation>c&apos;est un maillage fermé, qui n&apos;a pas de faces à choisir ; découpez-en ce qui est à couvrir (Mesh, Découpe), ou prenez le fichier dont il est issu</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/files/read.py"/>
        <source>it is a folder; name the file of the part</source>
        <translation>c&apos;est un dossier ; nommez le fichier de la pièce</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/names.py"/>
        <source>it is a reserved word</source>
        <translation>c&apos;est un mot réservé</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/wall_on.py"/>
        <source>it is a solid whose faces that are not flat ({0}) are not one wall; name the faces of the wall: part.faces of a job, or select them</source>
        <translation>c&apos;est un solide dont les faces non planes ({0}) ne sont pas une seule paroi ; nommez les faces de la paroi : part.faces d&apos;un travail, ou sélectionnez-les</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/clad_faces.py"/>
        <source>it is a solid with {0} face(s), and none is chosen; name those to cover: part.faces of a job, or select them</source>
        <translation>c&apos;est un solide de {0} face(s), et aucune n&apos;est choisie ; nommez celles à recouvrir : part.faces d&apos;une tâche, ou sélectionnez-les</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/files/three_mf.py"/>
        <source>it is compressed in a way that 3MF does not allow</source>
        <translation>il est comprimé d&apos;une façon que 3MF ne permet pas</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/revolution/patch.py"/>
        <source>it is cut out or slanted: an edge runs neither around nor along it</source>
        <translation>elle est découpée ou oblique : une arête n&apos;en fait pas le tour et ne court pas le long d&apos;elle</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/mesh_file.py"/>
        <source>it is cut short after {0} of {1} vertices; export it again</source>
        <translation>il est coupé après {0} de {1} sommets ; exportez-le de nouveau</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/files/read.py"/>
        <source>it is damaged or not what its ending says; export the part again</source>
        <translation>il est endommagé ou n&apos;est pas ce que dit son extension ; exportez la pièce de nouveau</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/files/apart.py"/>
        <source>it is damaged: FreeCAD crashes on it; export it again</source>
        <translation>il est endommagé : FreeCAD plante en le lisant ; exportez-le de nouveau</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/files/apart.py"/>
        <source>it is damaged: it takes more than {0} MB of memory to read, the limit of a file of its size; export it again</source>
        <translation>il est endommagé : sa lecture demande plus de {0} Mo de mémoire, la limite pour un fichier de sa taille ; exportez-le de nouveau</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/files/apart.py"/>
        <source>it is damaged: it takes more than {0} s of the processor to read, the limit of a file of its size; export it again</source>
        <translation>il est endommagé : sa lecture demande plus de {0} s de processeur, la limite pour un fichier de sa taille ; exportez-le de nouveau</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/kuka/read.py"/>
        <source>it is declared behind an instruction</source>
        <translation>il est déclaré après une instruction</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/names.py"/>
        <source>it is empty</source>
        <translation>il est vide</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/name_page.py"/>
        <source>it is empty; a machine file is worth no more than its check poses</source>
        <translation>il est vide ; un fichier de machine ne vaut pas plus que ses poses de contrôle</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/files/read.py"/>
        <source>it is empty; export the part again</source>
        <translation>il est vide ; exportez la pièce de nouveau</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/point_file.py"/>
        <source>it is empty; export the points again</source>
        <translation>il est vide ; exportez les points de nouveau</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/curves/curve_table.py"/>
        <source>it is empty; fill the gap, or leave the line out</source>
        <translation>elle est vide ; remplissez le vide, ou enlevez la ligne</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/figure_table.py"/>
        <source>it is empty; give a number</source>
        <translation>c&apos;est vide ; donnez un nombre</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/quantity.py"/>
        <source>it is empty; give a quantity in {0}</source>
        <translation>c&apos;est vide ; donnez une grandeur en {0}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/name_page.py"/>
        <source>it is empty; give maker and model</source>
        <translation>il est vide ; donnez le constructeur et le modèle</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/files/three_mf.py"/>
        <source>it is encrypted; export it without protection</source>
        <translation>il est chiffré ; exportez-le sans protection</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/files/three_mf.py"/>
        <source>it is encrypted; export plain triangles</source>
        <translation>il est chiffré ; exportez des triangles simples</translation>
    </message>
    <message>
        <location filename="../../freecad_am/macro/suit.py"/>
        <source>it is for kind: solid, not for {0}; leave it out</source>
        <translation>c’est pour kind: solid, pas pour {0} ; omettez-le</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/layers/curved/field.py"/>
        <source>it is for plane layers, not for curved ones; use {0}, or layers: planes</source>
        <translation>c&apos;est pour les couches planes, pas pour les courbes ; utilisez {0}, ou layers: planes</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>it is for solids, not for cladding; use {0}</source>
        <translation>c&apos;est pour les solides, pas pour le rechargement ; utilisez {0}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/curves/gcode.py"/>
        <source>it is in inches; let the slicer write mm (G21)</source>
        <translation>il est en pouces ; faites écrire des mm au trancheur (G21)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/simulation/run.py"/>
        <source>it is neither a joint path nor a program; select one of them</source>
        <translation>ce n&apos;est ni une trajectoire articulaire ni un programme ; sélectionnez l&apos;un d&apos;eux</translation>
    </message>
    <message>
        <location filename="../../freecad_am/macro/export.py"/>
        <source>it is neither a program nor an inspection; choose one</source>
        <translation>ce n’est ni un programme ni une inspection ; choisissez-en un</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/checks/placed.py"/>
        <source>it is neither a toolpath nor a joint path; give one</source>
        <translation>ce n&apos;est ni une trajectoire d&apos;outil ni une trajectoire articulaire ; donnez-en une</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/file.py"/>
        <source>it is nested too deeply to be a machine file; choose another file</source>
        <translation>ses niveaux sont trop nombreux pour un fichier de machine ; choisissez un autre fichier</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/mesh_file.py"/>
        <source>it is no PLY file that begins with its vertices; export it again</source>
        <translation>ce n&apos;est pas un fichier PLY qui commence par ses sommets ; exportez-le de nouveau</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/draft.py"/>
        <source>it is none of signs and a coupling of axes 2 and 3; copy the file itself</source>
        <translation>elle n&apos;est pas faite de signes et d&apos;un couplage des axes 2 et 3 ; copiez le fichier lui-même</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/kuka/read.py"/>
        <source>it is none of the lines that ArcTech has here, or names other data than the ones before it</source>
        <translation>ce n&apos;est aucune des lignes qu&apos;ArcTech a ici, ou elle nomme d&apos;autres données que celles d&apos;avant</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/hub.py"/>
        <source>it is not a cylinder and no cone; choose another face, or give strategy.base</source>
        <translation>ce n&apos;est ni un cylindre ni un cône ; choisissez une autre face, ou donnez strategy.base</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/yaskawa/read.py"/>
        <source>it is not a job from /JOB to END</source>
        <translation>ce n&apos;est pas un job de /JOB à END</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/source.py"/>
        <source>it is not a joint path; select one</source>
        <translation>ce n&apos;est pas une trajectoire articulaire ; sélectionnez-en une</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/fanuc/parsed.py"/>
        <source>it is not a listing with /PROG, /MN, /POS and /END in this order</source>
        <translation>ce n&apos;est pas un listing avec /PROG, /MN, /POS et /END dans cet ordre</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/modules.py"/>
        <source>it is not a module with one routine</source>
        <translation>ce n&apos;est pas un module à une seule routine</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/kuka/read.py"/>
        <source>it is not a module with one routine of the file&apos;s name, that begins with &amp;ACCESS RVP, &amp;REL 1 and DEF and ends with END: {0}</source>
        <translation>ce n’est pas un module avec une seule routine du nom du fichier, qui commence par &amp;ACCESS RVP, &amp;REL 1 et DEF et finit par END : {0}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/linuxcnc/read.py"/>
        <source>it is not a program that ends with M2</source>
        <translation>ce n&apos;est pas un programme qui finit par M2</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/staubli/files.py"/>
        <source>it is not a project in millimetres</source>
        <translation>ce n&apos;est pas un projet en millimètres</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/first_layer.py"/>
        <source>it is not a solid; choose a solid part for the wall to grow on</source>
        <translation>ce n&apos;est pas un solide ; choisissez une pièce solide sur laquelle la paroi doit croître</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/substrate.py"/>
        <source>it is not a solid; choose a solid part or a closed mesh for the wall to grow on</source>
        <translation>ce n&apos;est pas un solide ; choisissez une pièce solide ou un maillage fermé sur lequel la paroi doit croître</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/files/three_mf.py"/>
        <source>it is not a sound zip file ({0})</source>
        <translation>ce n&apos;est pas un fichier zip sain ({0})</translation>
    </message>
    <message>
        <location filename="../../freecad_am/macro/steps.py"/>
        <source>it is not a stage of this workbench; choose one</source>
        <translation>ce n&apos;est pas une étape de cet atelier ; choisissez-en une</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/model/bead_table.py"/>
        <source>it is not a table: it holds bytes that are not text in UTF-8; save it as CSV in UTF-8</source>
        <translation>ce n&apos;est pas un tableau : il contient des octets qui ne sont pas du texte UTF-8 ; enregistrez-le en CSV UTF-8</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/curves/ada3dp.py"/>
        <source>it is not a toolpath of AdaOne, or it is damaged ({0}); export it again</source>
        <translation>ce n&apos;est pas une trajectoire d&apos;AdaOne, ou elle est endommagée ({0}) ; exportez-la à nouveau</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/checks/predicted_shape.py"/>
        <source>it is not known how wide its beads count; plan it again</source>
        <translation>la largeur que comptent ses cordons n&apos;est pas connue ; replanifiez-la</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/revolution/patch.py"/>
        <source>it is not of revolution</source>
        <translation>elle n&apos;est pas de révolution</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/wall.py"/>
        <source>it is not on the surface of {0} ({1} mm off); walls of several surfaces cannot be deposited yet: choose faces of one torus, cylinder or cone</source>
        <translation>elle n&apos;est pas sur la surface de {0} (écart de {1} mm) ; les parois de plusieurs surfaces ne peuvent pas encore être déposées : choisissez des faces d&apos;un même tore, cylindre ou cône</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/ur/read.py"/>
        <source>it is not one function from its first line to its last</source>
        <translation>ce n&apos;est pas une seule fonction de la première ligne à la dernière</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/siemens/read.py"/>
        <source>it is not said which axes the feed is the speed of</source>
        <translation>il n&apos;est pas dit de quels axes l&apos;avance est la vitesse</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/staubli/files.py"/>
        <source>it is not text in UTF-8</source>
        <translation>ce n&apos;est pas un texte en UTF-8</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/table_part.py"/>
        <source>it is not text; give G-code</source>
        <translation>ce n&apos;est pas du texte ; donnez du G-code</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/table_part.py"/>
        <source>it is not text; give a table of points as CSV</source>
        <translation>ce n&apos;est pas du texte ; donnez un tableau de points en CSV</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/staubli/files.py"/>
        <source>it is not well-formed XML ({0})</source>
        <translation>ce n&apos;est pas du XML bien formé ({0})</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/torch.py"/>
        <source>it is open, so that nobody knows what is inside of it; give closed solids</source>
        <translation>elle est ouverte, si bien que nul ne sait ce qui est à l&apos;intérieur ; donnez des solides fermés</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/kuka/read.py"/>
        <source>it is set ahead of the motion, or its outputs cannot carry such a number</source>
        <translation>il est mis en avance sur le mouvement, ou ses sorties ne peuvent transmettre un tel numéro</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/layers/along/centre_line.py"/>
        <source>it is several solids</source>
        <translation>ce sont plusieurs solides</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/revolution/wall.py"/>
        <source>it is solid and has no {0} wall; use wall: outer</source>
        <translation>il est plein et n&apos;a pas de paroi {0} ; utilisez wall: outer</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/hub.py"/>
        <source>it is the inside of a bore; choose the outside of a hub, on which solids grow</source>
        <translation>c&apos;est l&apos;intérieur d&apos;un alésage ; choisissez l&apos;extérieur d&apos;un moyeu, sur lequel croissent les solides</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/poses_page.py"/>
        <source>it is the same in all poses, which proves nothing; add another pose</source>
        <translation>il est le même dans toutes les poses, ce qui ne prouve rien ; ajoutez une autre pose</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/linuxcnc/read.py"/>
        <source>it is waited for an analogue input within a bead</source>
        <translation>une entrée analogique est attendue au milieu d&apos;un cordon</translation>
    </message>
    <message>
        <location filename="../../freecad_am/read_back/events.py"/>
        <source>it is waited otherwise than planned</source>
        <translation>les attentes sont autres que planifié</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/calibration.py"/>
        <source>it is {0} mm and {1} deg from where the machine file has this joint, which is more than a calibration corrects; name the machine that it is of</source>
        <translation>elle est à {0} mm et {1} deg de l&apos;endroit où le fichier de machine place cette articulation, plus qu&apos;un étalonnage ne corrige ; nommez la machine dont il s&apos;agit</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/torch.py"/>
        <source>it is {0} mm from its origin, which is where the deposit comes out; put the tip of the wire or nozzle at the origin of the file, Z out of the nozzle, in mm</source>
        <translation>elle est à {0} mm de son origine, d&apos;où sort le dépôt ; placez la pointe du fil ou de la buse à l&apos;origine du fichier, Z sortant de la buse, en mm</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/revolution/wire.py"/>
        <source>it is {0} mm off the plane of the wire and its axis; draw the wire in a plane that holds the axis</source>
        <translation>il est à {0} mm hors du plan du fil et de son axe ; dessinez le fil dans un plan qui contient l&apos;axe</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/mesh_wall.py"/>
        <source>it is {0} pieces that do not hang together, and no layer starts on the one at {1}, {2} mm from where layers start; choose its edge to start from too, or deposit it by itself</source>
        <translation>ce sont {0} morceaux qui ne tiennent pas ensemble, et aucune couche ne commence sur celui en {1}, à {2} mm du départ des couches ; choisissez aussi son arête comme départ, ou déposez-le seul</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/scan_motion.py"/>
        <source>it lies as well on the part turned by {0} deg: the scan does not show which; give three points of it and where they are on the part as substrate.scan_pairs, or measure it in the part&apos;s coordinates</source>
        <translation>elle repose aussi bien sur la pièce tournée de {0} deg : la numérisation ne dit pas laquelle ; donnez trois de ses points et où ils sont sur la pièce par substrate.scan_pairs, ou mesurez-la dans les coordonnées de la pièce</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/names.py"/>
        <source>it may hold only the letters A to Z, digits and underscores</source>
        <translation>il ne peut contenir que les lettres A à Z, des chiffres et des tirets bas</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/fanuc/records.py"/>
        <source>it moves groups {0}, and has positions of others</source>
        <translation>il déplace les groupes {0}, et a des positions d&apos;autres groupes</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/fanuc/found.py"/>
        <source>it moves other groups than those before</source>
        <translation>il déplace d&apos;autres groupes que les précédents</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/ur/read.py"/>
        <source>it moves without a tool, without the platform, or in joints where positions are given</source>
        <translation>il se déplace sans outil, sans plateau, ou en valeurs articulaires là où des positions sont dites</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/names.py"/>
        <source>it must start with {0}</source>
        <translation>il doit commencer par {0}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/read_back/followed.py"/>
        <source>it names turns of other axes than the last one, which cannot be followed; give these positions in joints</source>
        <translation>il nomme des tours d&apos;autres axes que le dernier, ce qui ne peut être suivi ; donnez ces positions en valeurs d&apos;axes</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/files/three_mf.py"/>
        <source>it needs an extension that is not read ({0}); export plain triangles</source>
        <translation>il demande une extension qui n&apos;est pas lue ({0}) ; exportez des triangles simples</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/files/read.py"/>
        <source>it reaches to {0} mm, farther than {1} mm; a coordinate is damaged, or its unit is wrong; export the part again</source>
        <translation>il s&apos;étend jusqu&apos;à {0} mm, plus loin que {1} mm ; une coordonnée est endommagée ou son unité est fausse ; exportez la pièce de nouveau</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/torch.py"/>
        <source>it reaches {0} mm beyond its origin along Z, where the deposit is; let Z of the file point out of the nozzle, away from the torch, and put the origin at its tip</source>
        <translation>elle dépasse de {0} mm son origine selon Z, là où est le dépôt ; faites pointer le Z du fichier hors de la buse, à l&apos;opposé de la torche, et mettez l&apos;origine à sa pointe</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/staubli/moves.py"/>
        <source>it rounds corners or accelerates in a way that is not understood</source>
        <translation>il arrondit les angles ou accélère d&apos;une façon qui n&apos;est pas comprise</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/kuka/read.py"/>
        <source>it stands among the lines of another instruction</source>
        <translation>elle se trouve parmi les lignes d&apos;une autre instruction</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/mesh_wall.py"/>
        <source>it stands on a point and has no open end to start from; give a substrate that it grows on, or turn it so that an end lies on the platform</source>
        <translation>il repose sur un point et n&apos;a pas d&apos;extrémité ouverte où commencer ; donnez un substrat, ou tournez-le pour qu&apos;une extrémité repose sur le plateau</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/clearance/helpful.py"/>
        <source>it still does with {0}, each of which was tried; {1}</source>
        <translation>elle le fait aussi avec {0}, qui ont été essayés un à un ; {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/macro/arguments.py"/>
        <source>it takes one object alone; give that, and names of its faces apart</source>
        <translation>il faut un seul objet ; donnez-le, et à part les noms de ses faces</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/shapes/cell_obstacles.py"/>
        <source>it touches the nozzle at the first point of the job already, however the arm stands; its pose is that in the maker&apos;s base frame, and files are in mm: move it, or the deposition point</source>
        <translation>il touche déjà la buse au premier point du travail, quelle que soit la posture du bras ; sa pose est donnée dans le repère de base du constructeur, et les fichiers sont en mm : déplacez-le, ou le point de dépôt</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/layers/along/guide_edges.py"/>
        <source>it turns back by {0} deg at {1}: layers would go through what was deposited; choose edges that lead on</source>
        <translation>il fait demi-tour de {0} deg en {1} : les couches traverseraient ce qui est déposé ; choisissez des arêtes qui mènent plus loin</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/slicing/solids/unrolled.py"/>
        <source>it winds {0} times about the cone and would lie on itself when laid flat; divide it into shorter solids</source>
        <translation>il s&apos;enroule {0} fois autour du cône et se recouvrirait une fois mis à plat ; divisez-le en solides plus courts</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/files/three_mf.py"/>
        <source>its XML is damaged ({0})</source>
        <translation>son XML est endommagé ({0})</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/surfaces.py"/>
        <source>its beads fill solids, most are inside; compare the points with the feature</source>
        <translation>ses cordons remplissent des solides, la plupart sont à l&apos;intérieur ; comparez les points à l&apos;élément à déposer</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/views/joint_path.py"/>
        <source>its cell is gone; choose a cell for it</source>
        <translation>sa cellule a disparu ; choisissez-lui une cellule</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/inverse/opw_recognition.py"/>
        <source>its closed form is {0} mm and {1} (entries of the rotation) off</source>
        <translation>sa forme explicite s&apos;écarte de {0} mm et {1} (termes de la rotation)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/staubli/files.py"/>
        <source>its code does not run from begin to end</source>
        <translation>son code ne va pas de begin à end</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/curves/curve_table.py"/>
        <source>its columns are {0}; {1}</source>
        <translation>ses colonnes sont {0} ; {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/layers/along/guide_edges.py"/>
        <source>its edges are not one curve: {0} of {1} do not go on from where the others end, at {2} and {3}, and the nearest is {4} mm off; choose edges that meet end to end</source>
        <translation>ses arêtes ne font pas une courbe : {0} sur {1} ne continuent pas là où les autres finissent, en {2} et {3}, et la plus proche en est à {4} mm ; choisissez des arêtes qui se touchent bout à bout</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/revolution/wire.py"/>
        <source>its edges lie on the axis; choose another axis</source>
        <translation>ses arêtes sont sur l&apos;axe ; choisissez un autre axe</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/walls/fronts.py"/>
        <source>its end cuts the first layer off; make it longer</source>
        <translation>son extrémité coupe la première couche ; allongez-la</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/walls/plan.py"/>
        <source>its end does not lie above the substrate all around; make it longer</source>
        <translation>son extrémité n&apos;est pas au-dessus du substrat sur tout le tour ; allongez-la</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/wall_on.py"/>
        <source>its faces that are not flat run on smoothly into {0}, which is; name the faces of the wall: part.faces of a job, or select them</source>
        <translation>ses faces non planes se prolongent sans cassure en {0}, qui l&apos;est ; nommez les faces de la paroi : part.faces d&apos;un travail, ou sélectionnez-les</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/inverse/opw_recognition.py"/>
        <source>its first axis slides and carries the six that turn, as a track does</source>
        <translation>son premier axe coulisse et porte les six qui tournent, comme un rail</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/ur/read.py"/>
        <source>its function is called {0}</source>
        <translation>sa fonction s&apos;appelle {0}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/yaskawa/read.py"/>
        <source>its group is not that of its positions</source>
        <translation>son groupe n&apos;est pas celui de ses positions</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/fanuc/found.py"/>
        <source>its header names other motion groups than programs before</source>
        <translation>son en-tête nomme d&apos;autres groupes de mouvement que les programmes précédents</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/yaskawa/read.py"/>
        <source>its job is called {0}</source>
        <translation>son job s&apos;appelle {0}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/interop/source.py"/>
        <source>its joint path is gone; choose a joint path</source>
        <translation>sa trajectoire articulaire a disparu ; choisissez-en une</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/source.py"/>
        <source>its machine has two rotary axes, which leave no rotation about the tool to choose; open the map of a robot</source>
        <translation>sa machine a deux axes rotatifs, qui ne laissent aucune rotation autour de l&apos;outil à choisir ; ouvrez la carte d&apos;un robot</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/modules.py"/>
        <source>its module is called {0}, and the file is not, or another one is too</source>
        <translation>son module s&apos;appelle {0}, mais pas le fichier, ou un autre porte ce nom aussi</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/fanuc/post.py"/>
        <source>its motion group, 2 to {0}</source>
        <translation>son groupe de mouvement, de 2 à {0}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/fanuc/records.py"/>
        <source>its positions are not all of the same motion groups, or one is not understood</source>
        <translation>ses positions ne sont pas toutes des mêmes groupes de mouvement, ou l&apos;une n&apos;est pas comprise</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/yaskawa/read.py"/>
        <source>its positions are not pulses of one tool</source>
        <translation>ses positions ne sont pas des impulsions d&apos;un seul outil</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/kuka/read.py"/>
        <source>its routine is {0}, which is not the file&apos;s name; rename one of them</source>
        <translation>sa routine est {0}, ce qui n’est pas le nom du fichier ; renommez l’un des deux</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/inverse/recognition.py"/>
        <source>its solutions do not give back its poses</source>
        <translation>ses solutions ne redonnent pas ses poses</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/staubli/moves.py"/>
        <source>its speed is limited, or its tool fixed, in a way that is not understood</source>
        <translation>sa vitesse est limitée, ou son outil fixé, d&apos;une façon qui n&apos;est pas comprise</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/surface_patch.py"/>
        <source>its surface ({0}) cannot be converted to a spline; rebuild the face, for instance as a loft</source>
        <translation>sa surface ({0}) ne peut pas être dite par une spline ; reconstruisez la face, par exemple par lissage</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/ur/read.py"/>
        <source>its time, speed or blend is none that is kept</source>
        <translation>sa durée, sa vitesse ou son lissage n&apos;est pas de ceux qui sont tenus</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/views/joint_path.py"/>
        <source>its toolpath is gone; choose another, or delete the joint path too</source>
        <translation>sa trajectoire d&apos;outil a disparu ; choisissez-en une autre, ou supprimez aussi la trajectoire articulaire</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/read_process.py"/>
        <source>its triggers are not numbered in a row</source>
        <translation>ses déclencheurs ne sont pas numérotés à la suite</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/files/three_mf.py"/>
        <source>its unit {0} is none of {1}</source>
        <translation>son unité {0} n&apos;est aucune de {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/mesh_file.py"/>
        <source>its vertices have no plain x, y and z; export it again</source>
        <translation>ses sommets n&apos;ont pas de x, y et z simples ; exportez-le de nouveau</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/placement/dock.py"/>
        <source>its view was closed</source>
        <translation>sa vue a été fermée</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/read_process.py"/>
        <source>its weld data has no speed, or is of another seam</source>
        <translation>ses données de soudage n&apos;ont pas de vitesse, ou sont d&apos;un autre cordon</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/checks/placed.py"/>
        <source>its {0} is missing; choose one and recompute</source>
        <translation>son {0} manque ; choisissez-en un et recalculez</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>jerk</source>
        <translation>jerk</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/joint_path.py"/>
        <source>joining the beads by rapid moves</source>
        <translation>liaison des cordons par des mouvements rapides</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>joint</source>
        <translation>articulaire</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/fanuc/read.py"/>
        <source>joint and Cartesian positions are mixed</source>
        <translation>positions articulaires et cartésiennes sont mêlées</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/choices.py"/>
        <source>joint limits (Fournier)</source>
        <translation>limites articulaires (Fournier)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/choices.py"/>
        <source>joint limits (Klein)</source>
        <translation>limites articulaires (Klein)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/choices.py"/>
        <source>joint limits (Liégeois)</source>
        <translation>limites articulaires (Liégeois)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/colouring.py"/>
        <source>joint margin</source>
        <translation>marge articulaire</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/beads/chord_error.py"/>
        <source>joint motion leaves the bead between two points however many are added: near a singularity</source>
        <translation>le mouvement articulaire quitte le cordon entre deux points, si nombreux qu&apos;on les ajoute : près d&apos;une singularité</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/kuka/post.py"/>
        <source>joint moves of KRL run at whole percents of the axes&apos; speeds, so the speed along a bead would not be the one asked for; use `motion: cartesian`</source>
        <translation>les mouvements articulaires de KRL vont à des pourcentages entiers des vitesses des axes, et la vitesse le long d&apos;un cordon ne serait pas celle demandée ; prenez `motion: cartesian`</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/joint_path.py"/>
        <source>joint path</source>
        <translation>trajectoire articulaire</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/colouring.py"/>
        <source>joint speed</source>
        <translation>vitesse articulaire</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/certificate/bound.py"/>
        <source>joints.certificate: several solutions of this arm bear the same configuration, so no lower bound is known; leave it out</source>
        <translation>joints.certificate : plusieurs solutions de ce bras portent la même configuration, aucune borne inférieure n’est donc connue ; retirez ce paramètre</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/external/rule.py"/>
        <source>joints.external_axes: {0} is of no effect without cell.external; leave it out</source>
        <translation>joints.external_axes : {0} est sans effet sans cell.external ; à omettre</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/rotation/given.py"/>
        <source>joints.given is of no effect on the method {0}; use {1}, or take it out</source>
        <translation>joints.given est sans effet sur la méthode {0} ; utilisez {1}, ou retirez-le</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/rotation/given.py"/>
        <source>joints.given names beads that are not there: {0}; take them out</source>
        <translation>joints.given nomme des cordons qui n&apos;existent pas : {0} ; retirez-les</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/methods/layer_by_layer.py"/>
        <source>keeping the arm clear</source>
        <translation>dégagement du bras</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/toolpaths.py"/>
        <source>keeping the nozzle clear</source>
        <translation>maintien de la buse à distance</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/colouring.py"/>
        <source>kind of bead</source>
        <translation>type de cordon</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/colouring.py"/>
        <source>layer</source>
        <translation>couche</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/choices.py"/>
        <source>layer by layer</source>
        <translation>couche par couche</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>layer height</source>
        <translation>hauteur de couche</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/issues.py"/>
        <source>layer {0}</source>
        <translation>couche {0}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/issues.py"/>
        <source>layer {0} bead {1}</source>
        <translation>couche {0} cordon {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/checks/controllers.py"/>
        <source>layer {0} bead {1} has {2} points, and loading another part within a bead would stop the robot while it deposits; use at least {3}, or a larger strategy.chord_error</source>
        <translation>couche {0} cordon {1} a {2} points, et charger une autre partie au sein d&apos;un cordon arrêterait le robot pendant qu&apos;il dépose ; utilisez au moins {3}, ou une plus grande strategy.chord_error</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/issues.py"/>
        <source>layer {0} bead {1} point {2}</source>
        <translation>couche {0} cordon {1} point {2}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/shape/laying.py"/>
        <source>layer {0} of {1}</source>
        <translation>couche {0} sur {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/layers/curved/on_faces.py"/>
        <source>layer {0} of {1} would lie {2} mm above the faces, as far as a hollow reaches at {3}, and fold there; lay at most {4} layer(s), or leave out what is so hollow</source>
        <translation>la couche {0} de {1} se trouverait à {2} mm au-dessus des faces, aussi loin que va un creux en {3}, et s&apos;y replierait ; déposez au plus {4} couche(s), ou laissez de côté ce qui est si creux</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/issues.py"/>
        <source>layer {0} point {1}</source>
        <translation>couche {0} point {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/reading.py"/>
        <source>layer {}</source>
        <translation>couche {}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/program/located.py"/>
        <source>layer {} bead {}</source>
        <translation>couche {} cordon {}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>layer-by-layer</source>
        <translation>couche par couche</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/dock.py"/>
        <source>layers</source>
        <translation>couches</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/drawn/board.py"/>
        <source>layers ({} of {} beads)</source>
        <translation>couches ({} de {} cordons)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/read_back/events.py"/>
        <source>layers begin at other places than planned</source>
        <translation>des couches commencent ailleurs que planifié</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/fit_layers.py"/>
        <source>layers of the family {0} are not fitted to a scan yet; solids in plane layers and walls on a substrate are: leave the scan out</source>
        <translation>les couches de la famille {0} ne s&apos;ajustent pas encore à une numérisation ; les solides en couches planes et les parois sur un substrat le font : retirez la numérisation</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/checks.py"/>
        <source>layers of {0} mm are higher than the wall&apos;s smallest radius of curvature, {1} mm at {2}; use lower layers, or a larger radius there</source>
        <translation>des couches de {0} mm sont plus hautes que le plus petit rayon de courbure de la paroi, {1} mm en {2} ; prenez des couches plus basses, ou un plus grand rayon à cet endroit</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/mesh_wall.py"/>
        <source>layers of {0} mm ask for a mesh of the wall of about {1} triangles, and more than {2} cannot be worked with; give more than {3} mm, or deposit the wall in parts</source>
        <translation>des couches de {0} mm demandent un maillage de la paroi d&apos;environ {1} triangles, et il n&apos;est pas possible de travailler avec plus de {2} ; donnez plus de {3} mm, ou déposez la paroi en plusieurs parties</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/layers/along/guided.py"/>
        <source>layers of {0} stand normal to its centre line, {1} mm from {2} to {3}, which turns by {4} deg in all</source>
        <translation>les couches de {0} sont normales à sa ligne médiane, {1} mm de {2} à {3}, qui tourne de {4} deg en tout</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/solid_feature.py"/>
        <source>layers: {0} have no guide; use layers: along, or leave the guide out</source>
        <translation>les couches {0} n&apos;ont pas de guide ; utilisez layers: along, ou enlevez le guide</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/solid_feature.py"/>
        <source>layers: {0} have no start faces; use layers: geodesic or offset, or leave the faces out</source>
        <translation>`layers: {0}` n&apos;a pas de faces de départ ; utilisez layers: geodesic ou offset, ou omettez les faces</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/inspect.py"/>
        <source>laying the points onto the part</source>
        <translation>pose des points sur la pièce</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/revolution/tilt.py"/>
        <source>lead and tilt alone lean the tool by more than max_tilt ({0} deg); make them smaller or the cap larger</source>
        <translation>l&apos;angle d&apos;avance et l&apos;inclinaison seuls penchent l&apos;outil de plus que max_tilt ({0} deg) ; diminuez-les ou augmentez le maximum</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>least allowed</source>
        <translation>minimum permis</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/inverse/opw_recognition.py"/>
        <source>let the machine begin with the robot, and name the track in `cell.external` with `carries: robot`</source>
        <translation>faites commencer la machine au robot, et nommez le rail dans `cell.external` avec `carries: robot`</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>level</source>
        <translation>à plat</translation>
    </message>
    <message>
        <location filename="../../freecad_am/plots/look.py"/>
        <source>limits up to {0} {1}</source>
        <translation>limite {0} {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>limits up to {} {}</source>
        <translation>limite {} {}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/plots/look.py"/>
        <source>limits {0} to {1} {2}</source>
        <translation>limites {0} à {1} {2}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>limits {} to {} {}</source>
        <translation>limites {} à {} {}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>limits-fournier</source>
        <translation>limites (Fournier)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>limits-klein</source>
        <translation>limites (Klein)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>limits-liegeois</source>
        <translation>limites (Liégeois)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/facts.py"/>
        <source>line</source>
        <translation>ligne</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/yaskawa/post.py"/>
        <source>linear moves at the speed of a fixed nozzle over a part on the robot need the controller&apos;s external reference point, whose instruction is not documented well enough to write it; use `motion: joint`</source>
        <translation>les mouvements linéaires à la vitesse d&apos;une buse fixe sur une pièce portée par le robot demandent le point de référence externe de la commande, dont l&apos;instruction n&apos;est pas assez documentée pour l&apos;écrire ; utilisez `motion: joint`</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/yaskawa/post.py"/>
        <source>linear moves of a robot on a track have the base axis go along, and whether their speed counts its way was not confirmed; use `motion: joint`, whose shares of the joint speeds hold it</source>
        <translation>les mouvements linéaires d&apos;un robot sur un rail entraînent l&apos;axe de base, et il n&apos;a pas été confirmé si leur vitesse en compte le chemin ; utiliser `motion: joint`, dont les parts des vitesses articulaires la tiennent</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/fanuc/post.py"/>
        <source>linear moves over a part on a positioner are coordinated motion (COORD), and which user frame their positions are then seen from was not confirmed; use `motion: joint`, whose times hold the speed</source>
        <translation>les mouvements linéaires sur une pièce portée par un positionneur sont du mouvement coordonné (COORD), et le repère utilisateur d&apos;où leurs positions sont alors vues n&apos;a pas été confirmé ; utilisez `motion: joint`, dont les durées tiennent la vitesse</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/yaskawa/post.py"/>
        <source>linear moves over a part on a positioner are coordinated motion (SMOVL), and what their speed is of was not confirmed; use `motion: joint`, whose shares of the joint speeds hold it</source>
        <translation>les mouvements linéaires sur une pièce portée par un positionneur sont des mouvements coordonnés (SMOVL), et de quoi leur vitesse est celle n&apos;est pas confirmé ; utilisez `motion: joint`, dont les parts des vitesses articulaires la tiennent</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/path_view.py"/>
        <source>lines</source>
        <translation>lignes</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/choices.py"/>
        <source>lines of the surface</source>
        <translation>lignes de la surface</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/arm/kept.py"/>
        <source>link {0} comes nearer than {1} mm to {2}, or touches it on the rapid way to the bead; move one of them in cell.external or the part, try another cell.branch, or lower cell.arm_clearance</source>
        <translation>le corps {0} s’approche à moins de {1} mm de {2}, ou le touche, pendant le déplacement rapide vers le cordon ; déplacez l’un d’eux dans cell.external, ou la pièce, essayez une autre cell.branch, ou diminuez cell.arm_clearance</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/arm/kept.py"/>
        <source>link {0} comes nearer than {1} mm to {2}, or touches it on the rapid way to the bead; move the part or cell.deposition_point, try another cell.branch, or lower cell.arm_clearance</source>
        <translation>le corps {0} s’approche à moins de {1} mm de {2}, ou le touche, pendant le déplacement rapide vers le cordon ; déplacez la pièce ou cell.deposition_point, essayez une autre cell.branch, ou diminuez cell.arm_clearance</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/arm/kept.py"/>
        <source>link {0} comes nearer than {1} mm to {2}, or touches it; move one of them in cell.external or the part, try another cell.branch, or lower cell.arm_clearance</source>
        <translation>le corps {0} s’approche à moins de {1} mm de {2}, ou le touche ; déplacez l’un d’eux dans cell.external, ou la pièce, essayez une autre cell.branch, ou diminuez cell.arm_clearance</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/arm/kept.py"/>
        <source>link {0} comes nearer than {1} mm to {2}, or touches it; move the part or cell.deposition_point, try another cell.branch, or lower cell.arm_clearance</source>
        <translation>le corps {0} s’approche à moins de {1} mm de {2}, ou le touche ; déplacez la pièce ou cell.deposition_point, essayez une autre cell.branch, ou diminuez cell.arm_clearance</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/clearance.py"/>
        <source>links of the robot are drawn from the kinematics</source>
        <translation>les corps du robot sont dessinés d’après la cinématique</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/build_direction.py"/>
        <source>local</source>
        <translation>locale</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/colouring.py"/>
        <source>local distance</source>
        <translation>distance locale</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/build_direction.py"/>
        <source>local: tangent to the wall at each point; layer: one direction per layer; fixed: the axis of the part.</source>
        <translation>local : tangente à la paroi en chaque point ; layer : une direction par couche ; fixed : l&apos;axe de la pièce.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/report/of_document.py"/>
        <source>looking at what is promised</source>
        <translation>vérification de ce qui est promis</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/suited.py"/>
        <source>looking for a cell in which it can be done: {0}</source>
        <translation>recherche d&apos;une cellule où cela peut se faire : {0}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/in_sequence.py"/>
        <source>looking for beads over nothing</source>
        <translation>recherche de cordons au-dessus du vide</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/upright.py"/>
        <source>looking for what would clear the nozzle: {0}</source>
        <translation>recherche de ce qui dégagerait la buse : {0}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/remedies.py"/>
        <source>looking for what would make it feasible: {0}</source>
        <translation>recherche de ce qui le rendrait faisable : {0}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/checks/on_its_part.py"/>
        <source>looking whether the deposit lies on the part</source>
        <translation>vérification que le dépôt est sur la pièce</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/beads/speeds.py"/>
        <source>lower the travel speed to {0} mm/s</source>
        <translation>diminuez la vitesse d&apos;avance à {0} mm/s</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>lowest</source>
        <translation>la plus basse</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/feature_order.py"/>
        <source>lowest layer first</source>
        <translation>couche la plus basse d&apos;abord</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/inspection.py"/>
        <source>m</source>
        <translation>m</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/cell.py"/>
        <source>machine and setup</source>
        <translation>machine et setup</translation>
    </message>
    <message>
        <location filename="../../freecad_am/interop/robot_trajectory.py"/>
        <source>make a CAM path</source>
        <translation>faites une trajectoire CAM</translation>
    </message>
    <message>
        <location filename="../../freecad_am/interop/export.py"/>
        <source>making the report</source>
        <translation>établissement du rapport</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>manipulability</source>
        <translation>manipulabilité</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/simulation/bars.py"/>
        <source>margin</source>
        <translation>marge</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/readout.py"/>
        <source>margin {:.1f} % ({})</source>
        <translation>marge {:.1f} % ({})</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>mass</source>
        <translation>masse</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/program.py"/>
        <source>mass: {:.1f} g</source>
        <translation>masse : {:.1f} g</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>mean</source>
        <translation>moyenne</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/joints.py"/>
        <source>mean speed of each axis on each move, rapids included, against the machine file</source>
        <translation>vitesse moyenne de chaque axe sur chaque déplacement, rapides compris, comparée au fichier machine</translation>
    </message>
    <message>
        <location filename="../../freecad_am/report/of_document.py"/>
        <source>measuring the path</source>
        <translation>mesure de la trajectoire</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/walls/plan.py"/>
        <source>measuring {0} layers</source>
        <translation>mesure de {0} couches</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>middle</source>
        <translation>milieu</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/inspection.py"/>
        <source>mm</source>
        <translation>mm</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/columns.py"/>
        <source>more than one axis is called the track, or it has no value</source>
        <translation>plus d&apos;un axe est appelé le rail, ou il n&apos;a pas de valeur</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/checks.py"/>
        <source>more than two faces meet in one edge at {0}; a wall branches by smooth faces with openings: leave one of them out</source>
        <translation>plus de deux faces se rencontrent en une arête en {0} ; une paroi se ramifie par des faces lisses à ouvertures : laissez l&apos;une d&apos;elles de côté</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/clad_faces.py"/>
        <source>more than two faces meet in one edge at {0}; leave one of them out, or cover it as a feature of its own</source>
        <translation>plus de deux faces se rejoignent sur une arête en {0} ; laissez-en une de côté, ou recouvrez-la comme un élément à part</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/field.py"/>
        <source>more than {0}</source>
        <translation>plus de {0}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/slicing/backstop.py"/>
        <source>more than {0} layers of {1} mm: use a larger layer height</source>
        <translation>plus de {0} couches de {1} mm : utilisez une plus grande hauteur de couche</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/proposed_family.py"/>
        <source>most solids of {0} stand on a cylinder or cone of another of them</source>
        <translation>la plupart des solides de {0} se dressent sur un cylindre ou un cône de l&apos;un d&apos;eux</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/revolution/platform.py"/>
        <source>move the part up in its file, or set cell.platform_diameter to what there is (0 for none)</source>
        <translation>remontez la pièce dans son fichier, ou réglez cell.platform_diameter sur ce qui existe (0 pour aucun)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/columns.py"/>
        <source>moves of more than one tool or work object are mixed</source>
        <translation>des mouvements de plus d&apos;un outil ou d&apos;un objet de travail sont mêlés</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/yaskawa/read.py"/>
        <source>moves with another track or station than before are mixed</source>
        <translation>des mouvements d&apos;un autre rail ou d&apos;une autre station qu&apos;auparavant sont mêlés</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/kuka/read.py"/>
        <source>moves with other external axes are mixed</source>
        <translation>des mouvements avec d&apos;autres axes externes sont mêlés</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/drawn/picture.py"/>
        <source>near a singularity</source>
        <translation>près d&apos;une singularité</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/mesh/solid.py"/>
        <source>neighbouring triangles face opposite ways, for instance at {0}; turn them alike (Mesh, Harmonize normals)</source>
        <translation>des triangles voisins regardent en sens opposés, par exemple en {0} ; tournez-les pareillement (Mesh, Harmoniser les normales)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/inverse/recognition.py"/>
        <source>neither is the wrist spherical nor do axes 4 and 5 meet</source>
        <translation>le poignet n&apos;est pas sphérique et les axes 4 et 5 ne se coupent pas</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/model/bead_table.py"/>
        <source>no access</source>
        <translation>pas d&apos;accès</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/joints.py"/>
        <source>no axis has limits, or no point is reached</source>
        <translation>aucun axe n’a de limites, ou aucun point n’est atteint</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/revolution/wall.py"/>
        <source>no axis was found that its faces turn about; give it, or name the faces</source>
        <translation>aucun axe de rotation de ses faces n&apos;a été trouvé ; donnez-le, ou nommez les faces</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/colouring.py"/>
        <source>no bead model</source>
        <translation>pas de modèle de cordon</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>no bead model sets the speeds (process.bead_model)</source>
        <translation>aucun modèle de cordon ne règle les vitesses (process.bead_model)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/solids/plan.py"/>
        <source>no bead of {0} mm or more finds room in any layer; use a smaller bead spacing, or thin = single</source>
        <translation>aucun cordon de {0} mm ou plus ne trouve place dans aucune couche ; prenez une plus petite distance des cordons, ou thin = single</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/cladding.py"/>
        <source>no bead of {0} mm or more finds room on its faces; use a smaller bead spacing, or thin = single</source>
        <translation>aucun cordon de {0} mm ou plus ne trouve de place sur ses faces ; utilisez un espacement des cordons plus petit, ou thin = single</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/files/read.py"/>
        <source>no ending</source>
        <translation>aucune extension</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/layers/curved/field.py"/>
        <source>no face of it lies on the plane through its lowest place along strategy.direction, or on the substrate, so that there is nothing to begin on; turn the part, set strategy.direction, or give a substrate that it touches</source>
        <translation>aucune de ses faces ne repose sur le plan de son point le plus bas suivant strategy.direction, ni sur le substrat : rien où commencer ; tournez la pièce, donnez strategy.direction, ou un substrat qu&apos;elle touche</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/layers/curved/field.py"/>
        <source>no face of {0} lies on the faces chosen to start from, which are {1} mm away; choose faces that it touches, or none</source>
        <translation>aucune face de {0} ne repose sur les faces de départ choisies, qui sont à {1} mm ; choisissez des faces qu&apos;il touche, ou aucune</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/inspection.py"/>
        <source>no file of measured points is given; choose one</source>
        <translation>aucun fichier de points mesurés n&apos;est donné ; choisissez-en un</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/clearance.py"/>
        <source>no file says what {0} is made of</source>
        <translation>aucun fichier ne dit de quoi {0} est fait</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/joint_path.py"/>
        <source>no file says what {0} is made of, so nozzle, torch and robot are not kept clear of it; give its machine file bodies, or name what of it stands still in cell.obstacles</source>
        <translation>aucun fichier ne dit de quoi {0} est fait, si bien que buse, torche et robot n’en sont pas tenus à l’écart ; donnez bodies à son fichier de machine, ou nommez dans cell.obstacles ce qui en est immobile</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/choices.py"/>
        <source>no flip</source>
        <translation>non retourné</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/urdf/read.py"/>
        <source>no joint moves {0} against {1}; choose another link</source>
        <translation>aucune articulation ne déplace {0} par rapport à {1} ; choisissez un autre corps</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/urdf/machine.py"/>
        <source>no joint of {0} moves anything against {1}; name another link as base</source>
        <translation>aucune articulation de {0} ne meut quoi que ce soit par rapport à {1} ; nommer un autre corps comme base</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/walls/beads.py"/>
        <source>no layer has a corner; within the wall they turn by up to {0} deg/mm</source>
        <translation>aucune couche n&apos;a d&apos;angle ; dans la paroi elles tournent jusqu&apos;à {0} deg/mm</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>no limit known: the machine file has no max_acceleration</source>
        <translation>aucune limite connue : le fichier machine n&apos;a pas de max_acceleration</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>no limit known: the machine file has no max_jerk</source>
        <translation>aucune limite connue : le fichier machine n&apos;a pas de max_jerk</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>no limit known: the machine file has no max_speed</source>
        <translation>aucune limite connue : le fichier machine n&apos;a pas de max_speed</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/point_file.py"/>
        <source>no line of it has three numbers; give rows of x y z</source>
        <translation>aucune ligne n&apos;a trois nombres ; donnez des lignes de x y z</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/source_page.py"/>
        <source>no link is carried by {}</source>
        <translation>aucun corps n&apos;est porté par {}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/catalogue.py"/>
        <source>no machine known is of {0}; use one of {1}</source>
        <translation>aucune machine connue n&apos;est de {0} ; utilisez l&apos;un de {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/curves/gcode.py"/>
        <source>no move of it extrudes, so there is no bead; {0}</source>
        <translation>aucun de ses mouvements n&apos;extrude, il n&apos;y a donc pas de cordon ; {0}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/joints.py"/>
        <source>no point is reached</source>
        <translation>aucun point n’est atteint</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/slicing/tubes/constant_distance.py"/>
        <source>no point of the wall at v = {0} lies {1} mm from the layer below; keep the layer height below the wall&apos;s smallest radius of curvature</source>
        <translation>aucun point de la paroi en v = {0} n&apos;est à {1} mm de la couche du dessous ; gardez la hauteur de couche au-dessous du plus petit rayon de courbure de la paroi</translation>
    </message>
    <message>
        <location filename="../../freecad_am/read_back/ways.py"/>
        <source>no positioner</source>
        <translation>aucun positionneur</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/program.py"/>
        <source>no program fits its inputs ({0}); mend that and recompute it</source>
        <translation>aucun programme ne convient à ses entrées ({0}) ; corrigez cela et recalculez-le</translation>
    </message>
    <message>
        <location filename="../../freecad_am/report/of_document.py"/>
        <source>no result fits its inputs ({0}); recompute it first</source>
        <translation>aucun résultat ne correspond à ses entrées ({0}) ; recalculez-le d&apos;abord</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/placement/figures.py"/>
        <source>no rotation about the tool serves the others</source>
        <translation>aucune rotation autour de l&apos;outil ne dessert les autres</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/layers/along/centre_line.py"/>
        <source>no section lies where it stands</source>
        <translation>aucune section là où il repose</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/curves/ada3dp.py"/>
        <source>no segment of it deposits, so there is no bead; export a toolpath that deposits</source>
        <translation>aucun de ses segments ne dépose, il n&apos;y a donc pas de cordon ; exportez une trajectoire qui dépose</translation>
    </message>
    <message>
        <location filename="../../freecad_am/api.py"/>
        <source>no source</source>
        <translation>pas de source</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/picking/inputs.py"/>
        <source>none</source>
        <translation>aucun</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/slicing/solids/standing.py"/>
        <source>none of its solids stands on a cylinder or cone of another: name the hub as substrate, choose a face of it, or give strategy.base; what stands on a flat base is deposited by kind: solid</source>
        <translation>aucun de ses solides ne repose sur un cylindre ou un cône d&apos;un autre : nommez le moyeu comme substrat, choisissez une face de celui-ci, ou donnez strategy.base ; ce qui repose sur une base plane est déposé par kind: solid</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/revolution/wall.py"/>
        <source>none of its {0} solids is of revolution; name the faces of the wall</source>
        <translation>aucun de ses {0} solides n&apos;est de révolution ; nommez les faces de la paroi</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>none of these layers lies on another</source>
        <translation>aucune de ces couches ne repose sur une autre</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/remedies.py"/>
        <source>none of these makes the job feasible, each was tried: {0}</source>
        <translation>rien de ceci ne rend le travail faisable, tout a été essayé : {0}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/near_names.py"/>
        <source>none of {0} machines has a name like it; use one that `freecad-am machines` lists, such as {1}, or the path of a machine file or URDF</source>
        <translation>aucune des {0} machines n’a un nom semblable ; utilisez l’une de celles que `freecad-am machines` énumère, comme {1}, ou le chemin d’un fichier de machine ou d’un URDF</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/methods/constant.py"/>
        <source>none of {0} values of RZ keeps the links clear in the whole job; joints.method: layer-by-layer chooses one for each bead</source>
        <translation>aucune des {0} valeurs de RZ ne garde les corps dégagés dans tout le travail ; joints.method : layer-by-layer en choisit une par cordon</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/methods/constant.py"/>
        <source>none of {0} values of RZ serves for the whole job; the nearest to it is {1} deg</source>
        <translation>aucune de {0} valeurs de RZ ne sert pour tout le travail ; la plus proche est {1} deg</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/choices.py"/>
        <source>normal to a guide curve</source>
        <translation>normales à une courbe guide</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/map_file.py"/>
        <source>not allowed, or touching</source>
        <translation>non permis, ou contact</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/clearance.py"/>
        <source>not checked in full, for {0}: {1} links that move with their axes, every {2} deg of the whole motion, the nozzle every mm; they touch nothing</source>
        <translation>non vérifié en entier, car {0} : {1} corps qui bougent avec leurs axes, tous les {2} deg du mouvement entier, la buse tous les mm ; ils ne touchent rien</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/clearance.py"/>
        <source>not checked in full, for {0}: {1} links that move with their axes, every {2} deg of the whole motion, the nozzle every mm; they touch {3} with {4}</source>
        <translation>non vérifié en entier, car {0} : {1} corps qui bougent avec leurs axes, tous les {2} deg du mouvement entier, la buse tous les mm ; ils touchent {3} avec {4}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/deposit.py"/>
        <source>not checked: a bead model, or nothing, says how wide the beads are</source>
        <translation>non vérifié : un modèle de cordon, ou rien, dit la largeur des cordons</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/clearance.py"/>
        <source>not checked: build_direction.clearance is none</source>
        <translation>non vérifié : build_direction.clearance vaut none</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/deposit.py"/>
        <source>not checked: it is not known how wide the beads count</source>
        <translation>non vérifié : la largeur des cordons qui compte n’est pas connue</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/clearance.py"/>
        <source>not checked: no file says what {0} is made of</source>
        <translation>non vérifié : aucun fichier ne dit de quoi {0} est fait</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/written.py"/>
        <source>not checked: only the controller can show it</source>
        <translation>non vérifié : seule la commande peut le montrer</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/deposit.py"/>
        <source>not checked: planned by an earlier version</source>
        <translation>non vérifié : planifié par une version antérieure</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/payload.py"/>
        <source>not checked: the file of {0} gives no payload; deposit and what it grows on, where that is closed, at {1} g/cm3 (process.density)</source>
        <translation>non vérifié : le fichier de {0} n’indique pas de charge ; dépôt et ce sur quoi il repose, dans la mesure où c’est fermé, à {1} g/cm3 (process.density)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/clearance.py"/>
        <source>not checked: the machine file gives no shapes for its links</source>
        <translation>non vérifié : le fichier machine ne donne pas la forme de ses corps</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/deposit.py"/>
        <source>not checked: the part encloses no volume</source>
        <translation>non vérifié : la pièce n’enferme pas de volume</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/deposit.py"/>
        <source>not checked: the part has no faces to measure from</source>
        <translation>non vérifié : la pièce n’a pas de faces d’où mesurer</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/deposit.py"/>
        <source>not checked: the welder&apos;s own schedules, which are not known here, set the feed of {0}</source>
        <translation>non vérifié : des programmes de soudage propres, que personne ne connaît ici, disent au poste comment alimenter {0}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/checks.py"/>
        <source>not checked: there is no joint path</source>
        <translation>non vérifié : il n’y a pas de trajectoire articulaire</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/written.py"/>
        <source>not checked: there is no program that was read back</source>
        <translation>non vérifié : il n’y a pas de programme relu</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/deposit.py"/>
        <source>not checked: there is no wire, process.wire.feed is 0</source>
        <translation>non vérifié : il n’y a pas de fil, process.wire.feed est 0</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/clearance.py"/>
        <source>not checked: without the manufacturer&apos;s shapes, links drawn from the kinematics come nearer than {0} mm to nothing, checked every {1} deg</source>
        <translation>non vérifié : sans les formes du constructeur, les corps dessinés d’après la cinématique ne s’approchent à moins de {0} mm de rien, regardés tous les {1} deg</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/clearance.py"/>
        <source>not checked: without the manufacturer&apos;s shapes, links drawn from the kinematics come nearer than {0} mm to {1} with {2}, checked every {3} deg</source>
        <translation>non vérifié : sans les formes du constructeur, les corps dessinés d’après la cinématique s’approchent à moins de {0} mm de {1} avec {2}, regardés tous les {3} deg</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/clearance.py"/>
        <source>not checked: without the manufacturer&apos;s shapes, links drawn from the kinematics touch nothing, checked every {0} deg</source>
        <translation>non vérifié : sans les formes du constructeur, les corps dessinés d’après la cinématique ne touchent rien, regardés tous les {0} deg</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/clearance.py"/>
        <source>not checked: without the manufacturer&apos;s shapes, links drawn from the kinematics touch {0} with {1}, checked every {2} deg</source>
        <translation>non vérifié : sans les formes du constructeur, les corps dessinés d’après la cinématique touchent {0} avec {1}, regardés tous les {2} deg</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/yaskawa/read.py"/>
        <source>not every position has one of the external axes, or these are alone</source>
        <translation>toutes les positions n&apos;ont pas d&apos;axes externes, ou celles-ci sont seules</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/joints.py"/>
        <source>not known of this machine</source>
        <translation>inconnu de cette machine</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/staleness.py"/>
        <source>note</source>
        <translation>remarque</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/sequence.py"/>
        <source>nothing carries it: {0} of {1} mm of its first layer lie over nothing when they are deposited; move it onto what is there, give its substrate, or deposit first what it stands on</source>
        <translation>rien ne le porte : {0} des {1} mm de sa première couche sont au-dessus du vide au moment de leur dépôt ; posez-le sur ce qui existe, donnez son substrat, ou déposez d&apos;abord ce sur quoi il repose</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/dock.py"/>
        <source>nothing forbids it</source>
        <translation>rien ne l&apos;interdit</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/build_direction.py"/>
        <source>nozzle</source>
        <translation>buse</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/build_direction.py"/>
        <source>nozzle: tilt no more than needed to keep the nozzle clear of deposit and platform.</source>
        <translation>nozzle : pas plus d&apos;inclinaison qu&apos;il n&apos;en faut pour tenir la buse éloignée du dépôt et du plateau.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/files/three_mf.py"/>
        <source>object {0} of {1} has triangles with points that it has not</source>
        <translation>l&apos;objet {0} de {1} a des triangles dont il n&apos;a pas les points</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/files/three_mf.py"/>
        <source>object {0} of {1} holds itself</source>
        <translation>l&apos;objet {0} de {1} se contient lui-même</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/files/three_mf.py"/>
        <source>object {0} of {1} is moved by a matrix that flattens it</source>
        <translation>l&apos;objet {0} de {1} est déplacé par une matrice qui l&apos;aplatit</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/files/three_mf.py"/>
        <source>object {0} of {1} is not in it</source>
        <translation>l&apos;objet {0} de {1} n&apos;y est pas</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/files/three_mf.py"/>
        <source>object {0} of {1} {2} objects, or objects nested {3} times</source>
        <translation>objet {0} de {1} : {2} objets, ou objets imbriqués {3} fois</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/program/beads.py"/>
        <source>of an earlier version</source>
        <translation>d&apos;une version antérieure</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/revolution/wall.py"/>
        <source>of its {0} solids only {1} turns about an axis, {2} of its surface; name the faces of that one to deposit it alone, and deposit the others as walls on a part or solids on a hub</source>
        <translation>de ses {0} solides, seul {1} tourne autour d’un axe, {2} de sa surface ; nommez les faces de celui-ci pour le déposer seul, et déposez les autres comme parois sur une pièce ou solides sur un moyeu</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/point_file.py"/>
        <source>of {0} points {1} are kept, evenly</source>
        <translation>de {0} points {1} sont gardés, également répartis</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>off</source>
        <translation>écart</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>offset</source>
        <translation>décalées</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/rapids/findings.py"/>
        <source>on its way from the bead before the nozzle would meet {0} at every retract distance and direction tried, and no way round was found; move the seam or the part, or take a more slender nozzle</source>
        <translation>en venant du cordon précédent la buse rencontrerait {0} à chaque distance et direction de retrait essayée, et aucun contournement n’a été trouvé ; déplacez la couture ou la pièce, ou prenez une buse plus fine</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/refusals.py"/>
        <source>on this controller the speed of joint moves is programmed in percent of the axes&apos; largest speeds, and the machine file of {0} does not give them; add {1}</source>
        <translation>ce contrôleur reçoit la vitesse des mouvements articulaires en pourcentage des vitesses maximales des axes, et le fichier de machine de {0} ne les donne pas ; ajoutez {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/shape/compare.py"/>
        <source>on {0} % of the faces the predicted deposit does not reach {1} mm beyond the part, on {2} % it ends within the part: at {3} the part sticks out by {4} mm. {5}</source>
        <translation>sur {0} % des faces le dépôt prédit ne dépasse pas la pièce de {1} mm, sur {2} % il finit dans la pièce : en {3} la pièce dépasse de {4} mm. {5}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/shape/compare.py"/>
        <source>on {0} % of the faces the predicted deposit does not reach {1} mm beyond the part, on {2} % it ends within the part: at {3} there is none within {4} mm. {5}</source>
        <translation>sur {0} % des faces le dépôt prédit ne dépasse pas la pièce de {1} mm, sur {2} % il finit dans la pièce : en {3} il n&apos;y en a pas à moins de {4} mm. {5}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/shape/compare.py"/>
        <source>on {0} % of the faces the predicted deposit does not reach {1} mm beyond the part, on {2} % it ends within the part: at {3} {4} mm are left to machine. {5}</source>
        <translation>sur {0} % des faces le dépôt prédit ne dépasse pas la pièce de {1} mm, sur {2} % il finit dans la pièce : en {3} il reste {4} mm à usiner. {5}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/model/notes.py"/>
        <source>on {0} % of the length, in {1} of {2} beads and {3} segments, the width asked for takes a speed outside of the table&apos;s {4} to {5} mm/min; it is kept within, and the width is not held: it is {6} mm at its farthest from the {7} mm. Straight beads of the table are {8} to {9} mm wide: ask for a process.bead_width among these, or measure beads at other speeds</source>
        <translation>sur {0} % de la longueur, dans {1} de {2} cordons et {3} segments, la largeur demandée exige une vitesse hors de celles du tableau, {4} à {5} mm/min ; elle y est maintenue, et la largeur n&apos;est pas tenue : elle est de {6} mm au plus loin des {7} mm. Les cordons droits du tableau ont {8} à {9} mm de large : demandez une process.bead_width parmi celles-ci, ou mesurez des cordons à d&apos;autres vitesses</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/solids/notes.py"/>
        <source>on {0} of {1} beads in layer {2} bends follow one another too closely to turn the torch round them at {3}: it leans by {4} to {5} deg there instead of {6} deg; lean less, or allow a faster turn</source>
        <translation>sur {0} de {1} cordons de la couche {2} des courbes se suivent de trop près pour que la torche tourne à {3} : elle y penche de {4} à {5} deg au lieu de {6} deg ; penchez moins, ou permettez une rotation plus rapide</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/solids/notes.py"/>
        <source>on {0} of {1} beads in {2} layers from {3} to {4} bends follow one another too closely to turn the torch round them at {5}: it leans by {6} to {7} deg there instead of {8} deg; lean less, or allow a faster turn</source>
        <translation>sur {0} de {1} cordons dans {2} couches de {3} à {4} des courbes se suivent de trop près pour que la torche tourne à {5} : elle y penche de {6} à {7} deg au lieu de {8} deg ; penchez moins, ou permettez une rotation plus rapide</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/solids/notes.py"/>
        <source>on {0} of {1} beads the hub&apos;s normals alone turn by up to {2} deg/mm, faster than {3}; the torch follows them all the same</source>
        <translation>sur {0} de {1} cordons les normales du moyeu seules tournent jusqu&apos;à {2} deg/mm, plus vite que {3} ; la torche les suit malgré tout</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/solids/notes.py"/>
        <source>on {0} of {1} beads, {2} mm in all, the torch begins to turn ahead of corners, by up to {3} deg from what is asked, to turn no faster than {4}</source>
        <translation>sur {0} de {1} cordons, {2} mm en tout, la torche commence à tourner avant les angles, jusqu&apos;à {3} deg de ce qui est demandé, pour ne pas tourner plus vite que {4}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/feature_order.py"/>
        <source>one after the other</source>
        <translation>l&apos;un après l&apos;autre</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/shapes/part_file.py"/>
        <source>one object that nothing else is made from</source>
        <translation>un objet dont rien d&apos;autre n&apos;est fait</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/kuka/read.py"/>
        <source>one of its outputs switches the deposit</source>
        <translation>une de ses sorties commute le dépôt</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/staubli/read.py"/>
        <source>only a loop over one move is understood</source>
        <translation>seule une boucle sur un mouvement est comprise</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/ur/read.py"/>
        <source>only a loop that waits is understood</source>
        <translation>seule une boucle d&apos;attente est comprise</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>only solids in plane layers have sections and volumes of layers</source>
        <translation>seuls les solides en couches planes ont des sections et des volumes de couche</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/inspection.py"/>
        <source>only the deposit of a toolpath can be predicted; choose a toolpath under Planned, or a file of measured points</source>
        <translation>seul le dépôt d&apos;une trajectoire de dépôt peut être prédit ; choisissez-en une sous Planned, ou un fichier de points mesurés</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/facts.py"/>
        <source>open</source>
        <translation>ouvert</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/wall.py"/>
        <source>open, {:.1f} mm</source>
        <translation>ouverte, {:.1f} mm</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>optimised</source>
        <translation>optimisés</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/plan.py"/>
        <source>optimising the external axes</source>
        <translation>optimisation des axes externes</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/check_poses.py"/>
        <source>opw gives</source>
        <translation>opw donne</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/fields.py"/>
        <source>or {0}</source>
        <translation>ou {0}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/columns.py"/>
        <source>other external axes have values than in moves before, or not all in a row</source>
        <translation>d&apos;autres axes externes ont des valeurs que dans les mouvements précédents, ou ils ne se suivent pas</translation>
    </message>
    <message>
        <location filename="../../freecad_am/read_back/events.py"/>
        <source>other programs are called than planned</source>
        <translation>d&apos;autres programmes sont appelés que ceux planifiés</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/simulation/wording.py"/>
        <source>out of reach</source>
        <translation>hors d&apos;atteinte</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/readout.py"/>
        <source>out of reach with this branch</source>
        <translation>hors d&apos;atteinte avec cette branche</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>outer</source>
        <translation>extérieure</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/program.py"/>
        <source>output</source>
        <translation>sortie</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/dock.py"/>
        <source>over</source>
        <translation>selon</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/choices.py"/>
        <source>parallel to where it stands</source>
        <translation>parallèles à son appui</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>part</source>
        <translation>pièce</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/choices.py"/>
        <source>part on robot</source>
        <translation>pièce sur robot</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>part-on-robot</source>
        <translation>pièce sur le robot</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/inspection/view.py"/>
        <source>past the edges</source>
        <translation>au-delà des bords</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/dock.py"/>
        <source>path</source>
        <translation>trajectoire</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/picking/pick_field.py"/>
        <source>pick</source>
        <translation>choisir</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>place</source>
        <translation>position</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/choices.py"/>
        <source>plane of symmetry</source>
        <translation>plan de symétrie</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>planes</source>
        <translation>plans</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/joints.py"/>
        <source>planned joints of the deposit driven through the joint-frame chain, which planning does not use</source>
        <translation>articulations planifiées du dépôt menées par la chaîne des repères, que la planification n’emploie pas</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/placement/place.py"/>
        <source>planning the whole job at one of the best poses, the {0}.</source>
        <translation>planification de toute la tâche à l&apos;une des meilleures poses, la {0}e</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/place.py"/>
        <source>platform</source>
        <translation>plateau</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/choices.py"/>
        <source>point by point</source>
        <translation>point par point</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/work_offset.py"/>
        <source>point {0} is {1} mm from where it was touched (of all: {2} mm), more than cell.touched_tolerance of {3} mm; touch it again, and see that the points stand in the same order, are of this part, and that the tip is calibrated</source>
        <translation>le point {0} est à {1} mm d&apos;où il a été palpé (pour tous : {2} mm), plus que cell.touched_tolerance de {3} mm ; palpez-le de nouveau, et vérifiez que les points sont dans le même ordre, de cette pièce, et que la pointe est calibrée</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/facts.py"/>
        <source>point {} (0 to {}) at {:.2f}, {:.2f}, {:.2f} mm</source>
        <translation>point {} (0 à {}) en {:.2f}, {:.2f}, {:.2f} mm</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/facts.py"/>
        <source>point {} (0 to {}) of the layer, of the bead {}</source>
        <translation>point {} (0 à {}) de la couche, du cordon {}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>point-by-point</source>
        <translation>point par point</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/work_offset.py"/>
        <source>points are touched of a part that stands still under a tool on the robot; leave them out, and measure cell.platform or the pose of what carries the part</source>
        <translation>on palpe les points d&apos;une pièce immobile sous un outil porté par le robot ; retirez-les, et mesurez cell.platform ou la pose de ce qui porte la pièce</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/drawn/board.py"/>
        <source>points of layer {}</source>
        <translation>points de la couche {}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/mesh/repair.py"/>
        <source>points up to {0} mm apart were made one</source>
        <translation>des points écartés de {0} mm au plus ont été confondus</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/controls.py"/>
        <source>polynomials</source>
        <translation>polynômes</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/placement/place.py"/>
        <source>pose {0} of {1}</source>
        <translation>pose {0} sur {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/place.py"/>
        <source>positioner</source>
        <translation>positionneur</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/fanuc/found.py"/>
        <source>positions have a track and no remark says which axis it is, or the other way round</source>
        <translation>les positions ont un rail et aucune remarque ne dit quel axe c&apos;est, ou l&apos;inverse</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/staubli/moves.py"/>
        <source>positions of more than one frame are mixed</source>
        <translation>des positions de plus d&apos;un repère sont mêlées</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/linuxcnc/post.py"/>
        <source>positions on the part need the kinematics that M428 chooses; set it to true, or use `motion: joint`</source>
        <translation>les positions sur la pièce demandent la cinématique que choisit M428 ; mettez-le à true, ou utilisez `motion: joint`</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/checks/predicted_shape.py"/>
        <source>predicting the deposit, {0}</source>
        <translation>prédiction du dépôt, {0}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/simulation/payload.py"/>
        <source>process.density sets what it weighs; the payload is in the machine&apos;s file</source>
        <translation>process.density dit ce qu&apos;elle pèse ; ce que la machine porte est dans son fichier</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/program.py"/>
        <source>program</source>
        <translation>programme</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/linuxcnc/post.py"/>
        <source>programs of five-axis machines have no weave</source>
        <translation>les programmes des machines à cinq axes n&apos;ont pas de balayage</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/linuxcnc/post.py"/>
        <source>programs of five-axis machines switch the deposit between blocks, not at times before</source>
        <translation>les programmes des machines à cinq axes commutent le dépôt entre les blocs, non un temps avant</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/checks/controllers.py"/>
        <source>programs of {0} are not written with a positioner; plan without a program; waypoints.csv has all axes</source>
        <translation>les programmes de {0} ne sont pas écrits avec un positionneur ; planifier sans programme ; waypoints.csv a tous les axes</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/checks/controllers.py"/>
        <source>programs of {0} are not written with a positioner; use one of {1}</source>
        <translation>les programmes de {0} ne sont pas écrits avec un positionneur ; utiliser {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/checks/controllers.py"/>
        <source>programs of {0} are not written with a track and a positioner together; plan without a program; waypoints.csv has all axes</source>
        <translation>les programmes de {0} ne sont pas écrits avec un rail et un positionneur ensemble ; planifier sans programme ; waypoints.csv a tous les axes</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/checks/controllers.py"/>
        <source>programs of {0} are not written with a track and a positioner together; use one of {1}</source>
        <translation>les programmes de {0} ne sont pas écrits avec un rail et un positionneur ensemble ; utiliser {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/checks/controllers.py"/>
        <source>programs of {0} are not written with a track; plan without a program; waypoints.csv has all axes</source>
        <translation>les programmes de {0} ne sont pas écrits avec un rail ; planifier sans programme ; waypoints.csv a tous les axes</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/checks/controllers.py"/>
        <source>programs of {0} are not written with a track; use one of {1}</source>
        <translation>les programmes de {0} ne sont pas écrits avec un rail ; utiliser {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>proportional</source>
        <translation>proportionnelle</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/fields/pendants.py"/>
        <source>q1 to q4 are together {0} long, a quaternion is 1; look at the digits</source>
        <translation>q1 à q4 ont ensemble une longueur de {0}, un quaternion en a une de 1 ; vérifiez les chiffres</translation>
    </message>
    <message>
        <location filename="../../freecad_am/plots/fit.py"/>
        <source>r {0} mm, measured</source>
        <translation>r {0} mm, mesuré</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/table.py"/>
        <source>radius</source>
        <translation>rayon</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/simulation/bars.py"/>
        <source>range</source>
        <translation>plage</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>rapid</source>
        <translation>rapide</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/simulation/wording.py"/>
        <source>rapid move</source>
        <translation>mouvement rapide</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>rate</source>
        <translation>débit</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/field.py"/>
        <source>ratio range</source>
        <translation>plage de parts</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/written.py"/>
        <source>read back by a reader of its own and driven through the joint-frame chain and PyKDL</source>
        <translation>relu par un lecteur à part et mené par la chaîne des repères et PyKDL</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/written.py"/>
        <source>read back by a reader of its own and driven through the joint-frame chain; PyKDL is not installed</source>
        <translation>relu par un lecteur à part et mené par la chaîne des repères ; PyKDL n’est pas installé</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/program.py"/>
        <source>reading back and checking</source>
        <translation>relecture et vérification</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/shapes/part_file.py"/>
        <source>reading the file</source>
        <translation>lecture du fichier</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/inspection.py"/>
        <source>reading the points</source>
        <translation>lecture des points</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/program.py"/>
        <source>reading the program back does not give the planned path; do not use it</source>
        <translation>la relecture du programme ne donne pas la trajectoire planifiée ; ne l&apos;utilisez pas</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/stage.py"/>
        <source>recompute it</source>
        <translation>recalculez-le</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/methods/layer_by_layer.py"/>
        <source>refining layers</source>
        <translation>affinage des couches</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>refuse</source>
        <translation>refuser</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/mesh/solid.py"/>
        <source>repair the mesh (Mesh, Analyze)</source>
        <translation>réparez le maillage (Mesh, Analyser)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/interop/export.py"/>
        <source>reports are written as .html; end the name with it</source>
        <translation>les rapports sont écrits en .html ; terminez le nom ainsi</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/clearance.py"/>
        <source>retracts, travels and approaches driven again, at {0} places {1} mm apart, against bodies, platform and beads as wide and high as they are by then</source>
        <translation>retraits, transferts et approches menés à nouveau, en {0} points distants de {1} mm, contre les corps, le plateau et les cordons avec leur largeur et leur hauteur du moment</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/turns/locked.py"/>
        <source>robots need all their axes; only machines with rotary axes can do with four; use none</source>
        <translation>les robots ont besoin de tous leurs axes ; seules les machines à axes rotatifs peuvent se contenter de quatre ; utilisez none</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/kuka/read.py"/>
        <source>root and type are of two mechanisms, or the base is not the one selected</source>
        <translation>racine et type sont de deux mécanismes, ou la base n&apos;est pas celle choisie</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>rotary-table</source>
        <translation>plateau rotatif</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/map_file.py"/>
        <source>rotation</source>
        <translation>rotation</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/readout.py"/>
        <source>rotation not allowed</source>
        <translation>rotation non permise</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/model/predicted.py"/>
        <source>run as fast as the axes can follow, beads are predicted {0} to {1} mm high, {2} mm in the mean, at layers of {3} mm; set strategy.layer_height to what the beads make{4}</source>
        <translation>parcourus aussi vite que les axes peuvent suivre, les cordons sont prévus hauts de {0} à {1} mm, {2} mm en moyenne, pour des couches de {3} mm ; réglez strategy.layer_height sur ce que font les cordons{4}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/model/predicted.py"/>
        <source>run as fast as the axes can follow, beads are predicted {0} to {1} mm high, {2} mm in the mean, at layers of {3} mm{4}</source>
        <translation>parcourus aussi vite que les axes peuvent suivre, les cordons sont prévus hauts de {0} à {1} mm, {2} mm en moyenne, pour des couches de {3} mm{4}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>rz</source>
        <translation>RZ</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/new_job/fields.py"/>
        <source>saved cell: {}</source>
        <translation>cellule enregistrée : {}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/turns/fit.py"/>
        <source>seam moved for a limited axis</source>
        <translation>couture déplacée pour un axe limité</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/methods/constant.py"/>
        <source>searching one RZ for all</source>
        <translation>recherche d&apos;un RZ pour tous</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/methods/layer_by_layer.py"/>
        <source>searching rotations</source>
        <translation>recherche des rotations</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>second</source>
        <translation>second</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/deposit.py"/>
        <source>section of the wire times its feed, against width x height x speed of beads of each class, their starts and ends</source>
        <translation>section du fil fois sa vitesse, comparée à largeur x hauteur x vitesse des cordons de chaque classe, de leurs débuts et de leurs fins</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/picking/shape_inputs.py"/>
        <source>select</source>
        <translation>sélectionner</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/toolpath.py"/>
        <source>several features in one go are not fitted to a scan yet; leave it out, or deposit them one by one</source>
        <translation>plusieurs entités à la fois ne s&apos;ajustent pas encore à une numérisation ; retirez-la, ou déposez-les une par une</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/plan.py"/>
        <source>several solutions of this arm bear the same configuration; along each bead the one it begins with is followed</source>
        <translation>plusieurs solutions de ce bras ont la même configuration ; le long de chaque cordon, celle du début est suivie</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/clearance.py"/>
        <source>shapes of all links, against each other too, every {0} deg of the whole motion: they come nearer than {1} mm to nothing</source>
        <translation>formes de tous les corps, les uns par rapport aux autres aussi, tous les {0} deg de tout le mouvement : ils ne s’approchent à moins de {1} mm de rien</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/clearance.py"/>
        <source>shapes of all links, against each other too, every {0} deg of the whole motion: they come nearer than {1} mm to {2} with {3}</source>
        <translation>formes de tous les corps, les uns par rapport aux autres aussi, tous les {0} deg de tout le mouvement : ils s’approchent à moins de {1} mm de {2} avec {3}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/clearance.py"/>
        <source>shapes of all links, against each other too, every {0} deg of the whole motion: they touch nothing</source>
        <translation>formes de tous les corps, les uns par rapport aux autres aussi, tous les {0} deg de tout le mouvement : ils ne touchent rien</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/clearance.py"/>
        <source>shapes of all links, against each other too, every {0} deg of the whole motion: they touch {1} with {2}</source>
        <translation>formes de tous les corps, les uns par rapport aux autres aussi, tous les {0} deg de tout le mouvement : ils touchent {1} avec {2}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>share</source>
        <translation>part</translation>
    </message>
    <message>
        <location filename="../../freecad_am/plots/deviation.py"/>
        <source>share of the area</source>
        <translation>part de la surface</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>share of the length</source>
        <translation>part de la longueur</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>share of the limit</source>
        <translation>part de la limite</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>share of the points</source>
        <translation>part des points</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/inspection.py"/>
        <source>shift</source>
        <translation>translation</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/source_page.py"/>
        <source>sign</source>
        <translation>signe</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/poses_page.py"/>
        <source>signs and zeros of {} are others</source>
        <translation>les signes et zéros de {} sont autres</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>single</source>
        <translation>simple</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/source_page.py"/>
        <source>slides</source>
        <translation>glisse</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/regions/region.py"/>
        <source>slivers of {0} mm^2 were dropped</source>
        <translation>des éclats de {0} mm^2 ont été écartés</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>smooth</source>
        <translation>lisse</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/regions/region.py"/>
        <source>solids are filled with the Python package shapely (1.8 or newer), which is not installed; on Debian: apt-get install python3-shapely, elsewhere: pip install shapely</source>
        <translation>les solides sont remplis avec le paquet Python shapely (1.8 ou plus récent), qui n&apos;est pas installé ; sous Debian : apt-get install python3-shapely, ailleurs : pip install shapely</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/new_job/proposal.py"/>
        <source>some of what is selected is not a solid</source>
        <translation>une partie de la sélection n&apos;est pas un solide</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/refusals.py"/>
        <source>some points have no joint values; plan a joint path that reaches them all</source>
        <translation>certains points n&apos;ont pas de valeurs articulaires ; planifiez une trajectoire articulaire qui les atteint tous</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/stage.py"/>
        <source>something else is being computed; wait until that is done, or cancel it</source>
        <translation>autre chose est en cours de calcul ; attendez que ce soit fini, ou annulez-le</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/process.py"/>
        <source>spacing</source>
        <translation>distance des cordons</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/colouring.py"/>
        <source>speed</source>
        <translation>vitesse</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/model/bead_model.py"/>
        <source>speeds and radii vary only together</source>
        <translation>vitesses et rayons ne varient qu&apos;ensemble</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/inspect.py"/>
        <source>sphericity and circularity</source>
        <translation>sphéricité et circularité</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/facts.py"/>
        <source>spiral</source>
        <translation>spirale</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/curves/gcode.py"/>
        <source>splines are not known; let the slicer write lines and arcs</source>
        <translation>les splines ne sont pas connues ; faites écrire des lignes et des arcs au trancheur</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/turns/fit.py"/>
        <source>split for a limited axis</source>
        <translation>divisé pour un axe limité</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>spread</source>
        <translation>répartis</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/staleness.py"/>
        <source>stale</source>
        <translation>périmé</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/beads/phases.py"/>
        <source>start and end take {0} mm of this bead of {1} mm; make process.start and process.end shorter, or those of its class</source>
        <translation>le début et la fin prennent {0} mm de ce cordon de {1} mm ; raccourcissez process.start et process.end, ou ceux de sa classe</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/classes.py"/>
        <source>start and end take {0} mm with their ramps, and a bead of this class in layer {1} is {2} mm long; make them shorter for the class, or lay no beads as short as that</source>
        <translation>le début et la fin prennent {0} mm avec leurs rampes, et un cordon de cette classe dans la couche {1} est long de {2} mm ; raccourcissez-les pour la classe, ou ne déposez pas de cordons aussi courts</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/classes.py"/>
        <source>start and end take {0} mm, and a bead of this class in layer {1} is {2} mm long; make them shorter for the class, or lay no beads as short as that</source>
        <translation>le début et la fin prennent {0} mm, et un cordon de cette classe dans la couche {1} est long de {2} mm ; raccourcissez-les pour la classe, ou ne déposez pas de cordons aussi courts</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/name_page.py"/>
        <source>such as: pendant of R-30iB, 21 November; or a simulator with its version</source>
        <translation>par exemple : pupitre du R-30iB, 21 novembre ; ou un simulateur avec sa version</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/deposit.py"/>
        <source>surface of each layer of the predicted deposit, in the mean, against where the next one should begin</source>
        <translation>surface de chaque couche du dépôt prédit, en moyenne, par rapport à l&apos;endroit où la suivante devrait commencer</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/build_direction.py"/>
        <source>symmetry-plane</source>
        <translation>plan de symétrie</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/solids/plan.py"/>
        <source>symmetry-plane is for walls; plane layers grow along their normal: use local or fixed</source>
        <translation>symmetry-plane est pour les parois ; les couches planes croissent suivant leur normale : choisissez local ou fixed</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/revolution/plan.py"/>
        <source>symmetry-plane is not for parts of revolution; use local, layer or fixed</source>
        <translation>symmetry-plane n&apos;est pas pour les pièces de révolution ; utilisez local, layer ou fixed</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/denavit_hartenberg.py"/>
        <source>table, row {0}</source>
        <translation>tableau, ligne {0}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/inverse/opw_recognition.py"/>
        <source>take another link of a URDF, such as tool0 or fanuc_flange, or turn the flange</source>
        <translation>prenez un autre corps d&apos;un URDF, tel que tool0 ou fanuc_flange, ou tournez la bride</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/inverse/opw_recognition.py"/>
        <source>take the frame tool0 of a URDF, or move the flange</source>
        <translation>prenez le repère tool0 d&apos;un URDF, ou déplacez la bride</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/inverse/opw_recognition.py"/>
        <source>take the frame tool0 of a URDF, or turn the flange</source>
        <translation>prenez le repère tool0 d&apos;un URDF, ou tournez la bride</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/staubli/post.py"/>
        <source>that VAL 3 sets several outputs to one number was not found documented</source>
        <translation>il n&apos;a pas été trouvé documenté que VAL 3 mette plusieurs sorties à un seul numéro</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/process.py"/>
        <source>that a robot swings the part under a torch that stands was not confirmed</source>
        <translation>qu&apos;un robot balaie avec la pièce sous une torche fixe n&apos;a pas été confirmé</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/urdf/read.py"/>
        <source>the X of {0} points out of the flange, not its Z: it is turned there, as tool0 stands to flange</source>
        <translation>le X de {0} sort de la bride, et non son Z : il y est tourné, comme tool0 se place par rapport à flange</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/inverse/opw_recognition.py"/>
        <source>the Z of the flange does not lie along axis 6</source>
        <translation>le Z de la bride n&apos;est pas le long de l&apos;axe 6</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/inverse/opw_recognition.py"/>
        <source>the Z of the flange points back into the wrist, not out of it</source>
        <translation>le Z de la bride pointe vers le poignet et non vers l&apos;extérieur</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/linuxcnc/read.py"/>
        <source>the analogue output stops the machine within a bead</source>
        <translation>la sortie analogique arrête la machine au sein d&apos;un cordon</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/siemens/read.py"/>
        <source>the analogue output stops the machine within a bead, or its compressor</source>
        <translation>la sortie analogique arrête la machine au sein d&apos;un cordon, ou son compresseur</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/read_process.py"/>
        <source>the arc burns already, or is struck where the robot does not stand</source>
        <translation>l&apos;arc brûle déjà, ou est amorcé là où le robot n&apos;est pas à l&apos;arrêt</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/read.py"/>
        <source>the arc burns on a move of another kind</source>
        <translation>l&apos;arc brûle pendant un mouvement d&apos;une autre sorte</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/read_process.py"/>
        <source>the arc does not burn, or by another seam</source>
        <translation>l&apos;arc ne brûle pas, ou par un autre cordon</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/read_process.py"/>
        <source>the arc ends where the robot does not stop</source>
        <translation>l&apos;arc s&apos;éteint là où le robot ne s&apos;arrête pas</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/read_process.py"/>
        <source>the arc ends with other data than it burnt by</source>
        <translation>l&apos;arc s&apos;éteint avec d&apos;autres données que celles par lesquelles il brûlait</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/read_process.py"/>
        <source>the arc is struck with other weld data, or another weave</source>
        <translation>l&apos;arc est amorcé avec d&apos;autres données de soudage, ou un autre balayage</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/methods/closed_form.py"/>
        <source>the axes leave the bead by {0} mm, its direction by {1} deg between two points however many are added: near a pole; tilt away from it</source>
        <translation>les axes quittent le cordon de {0} mm, sa direction de {1} deg entre deux points, si nombreux qu&apos;on les ajoute : près d&apos;un pôle ; inclinez pour vous en éloigner</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/urdf/read.py"/>
        <source>the axis of {0} has no direction</source>
        <translation>l&apos;axe de {0} n&apos;a pas de direction</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/revolution/platform.py"/>
        <source>the axis of {0} is {1} deg off the normal of the platform</source>
        <translation>l&apos;axe de {0} est à {1} deg de la normale du plateau</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/revolution/platform.py"/>
        <source>the axis of {0} is {1} mm off the middle of the platform and misses it</source>
        <translation>l&apos;axe de {0} est à {1} mm du milieu du plateau et le manque</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/texts/touching.py"/>
        <source>the base</source>
        <translation>la base</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/yaskawa/post.py"/>
        <source>the base axis {0} of the robot</source>
        <translation>l&apos;axe de base {0} du robot</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/arm/kept.py"/>
        <source>the base comes nearer than {0} mm to {1}, or touches it on the rapid way to the bead; move one of them in cell.external or the part, try another cell.branch, or lower cell.arm_clearance</source>
        <translation>la base s’approche à moins de {0} mm de {1}, ou le touche, pendant le déplacement rapide vers le cordon ; déplacez l’un d’eux dans cell.external, ou la pièce, essayez une autre cell.branch, ou diminuez cell.arm_clearance</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/arm/kept.py"/>
        <source>the base comes nearer than {0} mm to {1}, or touches it on the rapid way to the bead; move the part or cell.deposition_point, try another cell.branch, or lower cell.arm_clearance</source>
        <translation>la base s’approche à moins de {0} mm de {1}, ou le touche, pendant le déplacement rapide vers le cordon ; déplacez la pièce ou cell.deposition_point, essayez une autre cell.branch, ou diminuez cell.arm_clearance</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/arm/kept.py"/>
        <source>the base comes nearer than {0} mm to {1}, or touches it; move one of them in cell.external or the part, try another cell.branch, or lower cell.arm_clearance</source>
        <translation>la base s’approche à moins de {0} mm de {1}, ou le touche ; déplacez l’un d’eux dans cell.external, ou la pièce, essayez une autre cell.branch, ou diminuez cell.arm_clearance</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/arm/kept.py"/>
        <source>the base comes nearer than {0} mm to {1}, or touches it; move the part or cell.deposition_point, try another cell.branch, or lower cell.arm_clearance</source>
        <translation>la base s’approche à moins de {0} mm de {1}, ou le touche ; déplacez la pièce ou cell.deposition_point, essayez une autre cell.branch, ou diminuez cell.arm_clearance</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/poses_page.py"/>
        <source>the base frame</source>
        <translation>le repère de base</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/revolution/platform.py"/>
        <source>the base of {0} has a diameter of {1} mm and reaches over the platform; check cell.platform_diameter (0 for none)</source>
        <translation>la base de {0} a un diamètre de {1} mm et dépasse du plateau ; vérifiez cell.platform_diameter (0 pour aucun)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/revolution/platform.py"/>
        <source>the base of {0} has a diameter of {1} mm and reaches over the platform; use cell.mount: feature, move the part, or check cell.platform_diameter (0 for none)</source>
        <translation>la base de {0} a un diamètre de {1} mm et dépasse du plateau ; utilisez cell.mount: feature, déplacez la pièce, ou vérifiez cell.platform_diameter (0 pour aucun)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/revolution/platform.py"/>
        <source>the base of {0} is {1} mm below the platform</source>
        <translation>la base de {0} est à {1} mm au-dessous du plateau</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/texts/touching.py"/>
        <source>the base touches {what}</source>
        <translation>la base touche {what}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/classes.py"/>
        <source>the bead model sets the travel speed of all beads; leave it out, or use bead_model: none</source>
        <translation>le modèle de cordon règle la vitesse d&apos;avance de tous les cordons ; omettez-la, ou prenez bead_model: none</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/model/bead_table.py"/>
        <source>the calibration table cannot be read ({0}); give none, csw or the path of one</source>
        <translation>le tableau d&apos;étalonnage ne peut pas être lu ({0}) ; donnez none, csw ou le chemin d&apos;un tableau</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/joint_path.py"/>
        <source>the cell that runs it</source>
        <translation>la cellule qui l&apos;exécute</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/simulation/payload.py"/>
        <source>the centre of gravity of the part, {0} kg by then, is {1} mm from the last axis of {2} ({3} mm when it is finished), which carries {4} mm with {5} kg; put it nearer to the middle (cell.platform may be a pose); {6}</source>
        <translation>le centre de gravité de la pièce, {0} kg à ce moment, est à {1} mm du dernier axe de {2} ({3} mm une fois finie), qui porte {4} mm avec {5} kg ; rapprochez-la du milieu (cell.platform peut être une pose) ; {6}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/simulation/payload.py"/>
        <source>the centre of gravity of the part, {0} kg by then, is {1} mm from the last axis of {2} ({3} mm when it is finished), which carries {4} mm; put it nearer to the middle (cell.platform may be a pose); {5}</source>
        <translation>le centre de gravité de la pièce, {0} kg à ce moment, est à {1} mm du dernier axe de {2} ({3} mm une fois finie), qui porte {4} mm ; rapprochez-la du milieu (cell.platform peut être une pose) ; {5}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/figures.py"/>
        <source>the circle at {0} mm was not measured all round: {1} deg between neighbours</source>
        <translation>le cercle à {0} mm n&apos;a pas été mesuré sur tout le tour : {1} deg entre voisins</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/entries.py"/>
        <source>the closed form is for six joints, there are {0}; leave opw out</source>
        <translation>la forme explicite est pour six articulations, il y en a {0} ; omettez opw</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/columns.py"/>
        <source>the configurations that its positions name are supervised, and are none</source>
        <translation>les configurations que nomment ses positions sont surveillées, et n&apos;en sont pas</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/kuka/post.py"/>
        <source>the controller has numbers up to {0}, not {1}; use one of these</source>
        <translation>la commande a des numéros jusqu&apos;à {0}, pas {1} ; prenez l&apos;un de ceux-ci</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/refusals.py"/>
        <source>the controller has weaves 1 to {0}, not {1}</source>
        <translation>la commande a les balayages 1 à {0}, pas {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/checks/controllers.py"/>
        <source>the controller of {0} does not read {1}; there is no post for it yet: plan without a program; waypoints.csv has its axes</source>
        <translation>la commande de {0} ne lit pas {1} ; il n&apos;y a pas encore de post-processeur pour elle : planifiez sans programme ; waypoints.csv a ses axes</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/checks/controllers.py"/>
        <source>the controller of {0} does not read {1}; use one of {2}</source>
        <translation>la commande de {0} ne lit pas {1} ; utilisez l&apos;un de {2}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/refusals.py"/>
        <source>the controller takes schedules up to {0}, not {1}; use another number, there or in process.classes</source>
        <translation>le contrôleur reçoit des programmes de soudage jusqu&apos;à {0}, non {1} ; prenez un autre numéro, là ou dans process.classes</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/refusals.py"/>
        <source>the controller&apos;s program reads analogue inputs 1 to {0}, not {1}; use one of these</source>
        <translation>le programme de la commande lit les entrées analogiques 1 à {0}, et non {1} ; utilisez l&apos;une d&apos;elles</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/siemens/post.py"/>
        <source>the controller&apos;s program reads inputs 1 to {0}, not {1}; use one of these</source>
        <translation>le programme de la commande lit les entrées 1 à {0}, et non {1} ; utilisez l&apos;une d&apos;elles</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/nc/parts.py"/>
        <source>the controller&apos;s program sets analogue outputs 1 to {0}, not {1}; use one of these</source>
        <translation>le programme de la commande règle les sorties analogiques 1 à {0}, et non {1} ; utilisez l&apos;une d&apos;elles</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/refusals.py"/>
        <source>the corner before the move at the end of which the deposit is switched is rounded, and leaves {0} s of it, less than the {1} s that it would be switched ahead; use a program.trigger.lead of {2} s at most, a smaller program.blend, or a larger strategy.chord_error</source>
        <translation>le coin avant le mouvement à la fin duquel le dépôt est commuté est arrondi, et n’en laisse que {0} s, moins que les {1} s d’avance de la commutation ; utilisez un program.trigger.lead d’au plus {2} s, un plus petit program.blend, ou une plus grande strategy.chord_error</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/texts/touching.py"/>
        <source>the deposit</source>
        <translation>le dépôt</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/program/linear_approach.py"/>
        <source>the deposit begins with a linear move onto the bead, and the program begins at the bead itself; give a retract distance, or another {0}</source>
        <translation>le dépôt commence par un mouvement linéaire vers le cordon, et le programme commence au cordon même ; donnez une distance de retrait, ou un autre {0}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/program/linear_approach.py"/>
        <source>the deposit begins with a linear move onto the bead, which would leave the checked way by {0} mm; give a shorter retract distance, or another {1}</source>
        <translation>le dépôt commence par un mouvement linéaire vers le cordon, qui s&apos;écarterait de {0} mm du chemin examiné ; donnez une distance de retrait plus courte, ou un autre {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/read_back/switched.py"/>
        <source>the deposit is still on where the program ends</source>
        <translation>le dépôt est encore en marche là où le programme se termine</translation>
    </message>
    <message>
        <location filename="../../freecad_am/read_back/switched.py"/>
        <source>the deposit is switched on where it is on already</source>
        <translation>le dépôt est mis en marche là où il l’est déjà</translation>
    </message>
    <message>
        <location filename="../../freecad_am/read_back/events.py"/>
        <source>the deposit is switched otherwise than planned</source>
        <translation>le dépôt est commandé autrement que planifié</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/docks/lookout.py"/>
        <source>the document was closed</source>
        <translation>le document a été fermé</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/start_edges.py"/>
        <source>the edge is {0} mm off the wall at {1}; choose edges of the wall&apos;s own faces</source>
        <translation>l&apos;arête est à {0} mm de la paroi en {1} ; choisissez des arêtes des faces mêmes de la paroi</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/curves_feature.py"/>
        <source>the edges, wire, sketch or table of points to lay as beads; faces beside edges give the directions</source>
        <translation>les arêtes, le fil, l&apos;esquisse ou le tableau de points à déposer en cordons ; des faces à côté des arêtes donnent les directions</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/curves/gcode.py"/>
        <source>the ends of the arc are {0} and {1} mm from its middle; give I and J from its start to its middle</source>
        <translation>les extrémités de l&apos;arc sont à {0} et {1} mm de son centre ; donnez I et J de son début à son centre</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/kuka/read.py"/>
        <source>the external axes are not given in order, or BASE is not coupled to what they move</source>
        <translation>les axes externes ne sont pas dans l&apos;ordre, ou BASE n&apos;est pas couplée à ce qu&apos;ils déplacent</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/refusals.py"/>
        <source>the external axes would end with number {0}, and the controller has {1}; use a smaller first one</source>
        <translation>les axes externes finiraient au numéro {0}, et la commande en a {1} ; prenez un premier plus petit</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/cuts.py"/>
        <source>the face folds back and cuts itself at {0}; give the bend a larger radius than the tube</source>
        <translation>la face se replie et se coupe elle-même en {0} ; donnez au coude un rayon plus grand que celui du tube</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/proposed_family.py"/>
        <source>the faces chosen of {0} turn about one axis</source>
        <translation>les faces choisies de {0} tournent autour d&apos;un axe</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/checks.py"/>
        <source>the faces form {0} separate pieces: {1} and {2} are {3} mm apart at {4}; choose connected faces, edges meeting within {5} mm</source>
        <translation>les faces forment {0} morceaux séparés : {1} et {2} sont à {3} mm l&apos;une de l&apos;autre en {4} ; choisissez des faces jointes, dont les arêtes se rencontrent à {5} mm près</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/wall.py"/>
        <source>the faces of the wall do not close around; walls that are open (half shells) cannot be deposited yet: choose a full tube</source>
        <translation>les faces de la paroi ne se ferment pas sur le tour ; les parois ouvertes (demi-coques) ne peuvent pas encore être déposées : choisissez un tube entier</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/cladding_feature.py"/>
        <source>the faces to cover</source>
        <translation>les faces à recouvrir</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/toolpath.py"/>
        <source>the feature to deposit</source>
        <translation>l&apos;élément à déposer</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/inspection.py"/>
        <source>the feature, toolpath, or object with a shape or mesh that was measured</source>
        <translation>l&apos;élément, la trajectoire d&apos;outil, ou l&apos;objet à forme ou maillage qui a été mesuré</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/tree.py"/>
        <source>the file cannot be read: {0}; choose one that can</source>
        <translation>le fichier ne peut pas être lu : {0} ; choisissez-en un qui peut l&apos;être</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/tree.py"/>
        <source>the file is empty; give at least {0}</source>
        <translation>le fichier est vide ; donnez au moins {0}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/file_content.py"/>
        <source>the file is larger than {0} MB, the most that is read; check that it is the right one</source>
        <translation>le fichier dépasse {0} Mo, le maximum qui est lu ; vérifiez que c&apos;est le bon</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/files/apart.py"/>
        <source>the file is larger than {0} MB, the most that is read; is it the right one?</source>
        <translation>le fichier dépasse {0} Mo, le maximum qui est lu ; est-ce le bon ?</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/staubli/files.py"/>
        <source>the file is missing</source>
        <translation>le fichier manque</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/slicing/first_layer.py"/>
        <source>the first layer does not run once around the wall: choose one closed loop of edges that crosses each line up the wall once</source>
        <translation>la première couche ne fait pas une fois le tour de la paroi : choisissez une boucle fermée d&apos;arêtes qui croise une fois chaque ligne montant la paroi</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/mesh_wall.py"/>
        <source>the first layer is the edge of {0} at {1}, which stands on the platform</source>
        <translation>la première couche est l&apos;arête de {0} en {1}, qui repose sur le plateau</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/mesh_wall.py"/>
        <source>the first layer is the lowest open end of {0}, Edge1 at {1}, which does not lie on the platform</source>
        <translation>la première couche est l&apos;extrémité ouverte la plus basse de {0}, Edge1 en {1}, qui ne repose pas sur le plateau</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/patch_wall.py"/>
        <source>the first layer lies on the wall and on {0}</source>
        <translation>la première couche repose sur la paroi et sur {0}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/first_layer.py"/>
        <source>the first layer lies on the wall and on {0} within {1} mm</source>
        <translation>la première couche repose sur la paroi et sur {0} à {1} mm près</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/mesh_wall.py"/>
        <source>the first layer runs {0} mm over the floor of {1}, which is not deposited</source>
        <translation>la première couche court à {0} mm au-dessus du fond de {1}, qui n&apos;est pas déposé</translation>
    </message>
    <message>
        <location filename="../../freecad_am/read_back/times.py"/>
        <source>the first move, from wherever the machine stands, is not as slow as it has to be</source>
        <translation>le premier mouvement, d&apos;où que parte la machine, n&apos;est pas aussi lent qu&apos;il le doit</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/poses_page.py"/>
        <source>the flange</source>
        <translation>la bride</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/inverse/opw_recognition.py"/>
        <source>the flange&apos;s origin does not lie on axis 6</source>
        <translation>l&apos;origine de la bride n&apos;est pas sur l&apos;axe 6</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/columns.py"/>
        <source>the four numbers of an orientation are not those of a unit quaternion</source>
        <translation>les quatre nombres d&apos;une orientation ne sont pas ceux d&apos;un quaternion unitaire</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/kernel/limits.py"/>
        <source>the geometry kernel cannot divide this face into triangles; repair it (Part, Check geometry), or redraw it</source>
        <translation>le noyau géométrique ne peut pas diviser cette face en triangles ; réparez-la (Part, Vérifier la géométrie), ou redessinez-la</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/kernel/limits.py"/>
        <source>the geometry kernel cannot work with this shape ({0}); repair it (Part, Check geometry), or redraw its faces</source>
        <translation>le noyau géométrique ne peut pas traiter cette forme ({0}) ; réparez-la (Part, Vérifier la géométrie), ou redessinez ses faces</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/layers/along/field.py"/>
        <source>the guide bends more tightly at {0} than the part is wide there: planes normal to it cross one another within the part, at {1}; choose a guide nearer to the inside of the bend or with a larger radius, or strategy.layers: geodesic</source>
        <translation>le guide est plus courbé en {0} que la pièce n&apos;y est étroite : ses plans normaux se croisent dans la pièce, en {1} ; choisissez un guide plus près de l&apos;intérieur du coude ou de plus grand rayon, ou strategy.layers: geodesic</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/layers/along/guide_edges.py"/>
        <source>the guide has no edge with a length; choose edges, a wire or a sketch</source>
        <translation>le guide n&apos;a aucune arête de longueur non nulle ; choisissez des arêtes, un fil ou une esquisse</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/layers/along/field.py"/>
        <source>the guide leaves the part: at layer {0} it is {1} mm off it, at {2}; choose a guide in the part or along one of its edges, or guide: auto</source>
        <translation>le guide quitte la pièce : à la couche {0} il est à {1} mm à côté, en {2} ; choisissez un guide dans la pièce ou le long de l&apos;une de ses arêtes, ou guide: auto</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/slicing/solids/standing.py"/>
        <source>the hub has no cylinder and no cone on its outside; choose a face of it, or give strategy.base</source>
        <translation>le moyeu n&apos;a ni cylindre ni cône à son extérieur ; choisissez une de ses faces, ou donnez strategy.base</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/developable_feature.py"/>
        <source>the hub, a cylinder or cone that the solids stand on, is not known: choose it as substrate, choose faces of it, or give strategy.base; what stands on a flat base is deposited by kind: solid</source>
        <translation>le moyeu, un cylindre ou un cône sur lequel reposent les solides, est inconnu : choisissez-le comme substrat, choisissez-en des faces, ou donnez strategy.base ; ce qui repose sur une base plane est déposé par kind: solid</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/read.py"/>
        <source>the instruction {0} is not understood</source>
        <translation>l&apos;instruction {0} n&apos;est pas comprise</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/yaskawa/read.py"/>
        <source>the instructions do not begin as those of a robot&apos;s job do</source>
        <translation>les instructions ne commencent pas comme celles d&apos;un job de robot</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/check_poses.py"/>
        <source>the joint frames give</source>
        <translation>les repères articulaires donnent</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/program.py"/>
        <source>the joint path to write</source>
        <translation>la trajectoire articulaire à écrire</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/urdf/read.py"/>
        <source>the joint {0} follows another one, which a serial chain cannot</source>
        <translation>l&apos;articulation {0} en suit une autre, ce qu&apos;une chaîne en série ne peut pas</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/urdf/read.py"/>
        <source>the joint {0} has no &lt;limit&gt;; one that turns without end is continuous</source>
        <translation>l&apos;articulation {0} n&apos;a pas de &lt;limit&gt; ; une qui tourne sans fin est continuous</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/urdf/read.py"/>
        <source>the joint {0} is {1}; only {2} and fixed ones are read</source>
        <translation>l&apos;articulation {0} est {1} ; seules {2} et fixed sont lues</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/tree.py"/>
        <source>the key stands twice (lines {0} and {1}); remove one</source>
        <translation>la clé est là deux fois (lignes {0} et {1}) ; retirez-en une</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/file.py"/>
        <source>the key {0} is missing; add it</source>
        <translation>la clé {0} manque ; ajoutez-le</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/file.py"/>
        <source>the key {0} is not known; use {1}</source>
        <translation>la clé {0} n&apos;est pas connue ; utilisez {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/calibration.py"/>
        <source>the key {0} is there twice; give the file as ur_calibration wrote it</source>
        <translation>la clé {0} s&apos;y trouve deux fois ; donnez le fichier tel que ur_calibration l&apos;a écrit</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/linuxcnc/read.py"/>
        <source>the kinematics changes while the deposit is on</source>
        <translation>la cinématique change pendant que le dépôt est en marche</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/urdf/read.py"/>
        <source>the limits of {0} run from {1} to {2}; give the lower one first</source>
        <translation>les limites de {0} vont de {1} à {2} ; donnez d&apos;abord la plus basse</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/layers/along/centre_line.py"/>
        <source>the line of {0} mm leads through {1} % of the volume</source>
        <translation>la ligne de {0} mm traverse {1} % du volume</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/texts/touching.py"/>
        <source>the link of {axis}</source>
        <translation>le corps de {axis}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/texts/touching.py"/>
        <source>the link of {axis} touches {what}</source>
        <translation>le corps de {axis} touche {what}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/urdf/read.py"/>
        <source>the link {0} carries itself; correct parent and child of its joints</source>
        <translation>le corps {0} se porte lui-même ; corrigez parent et child de ses articulations</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/urdf/read.py"/>
        <source>the link {0} does not carry {1}; choose others</source>
        <translation>le corps {0} ne porte pas {1} ; choisissez-en d&apos;autres</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/urdf/read.py"/>
        <source>the link {0} is moved by {1} already</source>
        <translation>le corps {0} est déjà mû par {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/staubli/post.py"/>
        <source>the links of analogue inputs differ from controller to controller, and the post staubli knows none</source>
        <translation>les liens des entrées analogiques diffèrent d&apos;une commande à l&apos;autre, et le post-processeur staubli n&apos;en connaît aucun</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/walls/beads.py"/>
        <source>the local distance between layers is {0} to {1} mm</source>
        <translation>la distance locale entre les couches est de {0} à {1} mm</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/walls/beads.py"/>
        <source>the local distance between layers is {0} to {1} mm, the layer height {2} mm; a larger strategy.tolerance says that this will do</source>
        <translation>la distance locale entre les couches est de {0} à {1} mm, la hauteur de couche de {2} mm ; un strategy.tolerance plus grand dit que cela suffit</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/walls/beads.py"/>
        <source>the local distance between layers is {0} to {1} mm, the layer height {2} mm; spacing: constant-distance is even</source>
        <translation>la distance locale entre les couches est de {0} à {1} mm, la hauteur de couche de {2} mm ; spacing: constant-distance est égal</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/poses_page.py"/>
        <source>the machine does not give them; see the deviations</source>
        <translation>la machine ne les donne pas ; voyez les écarts</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/joints.py"/>
        <source>the machine file gives no largest speeds</source>
        <translation>le fichier machine ne donne pas de vitesses maximales</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/yaskawa/post.py"/>
        <source>the machine file has no controller.pulses_per_degree; add them</source>
        <translation>le fichier machine n&apos;a pas de controller.pulses_per_degree ; ajoutez-les</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/yaskawa/post.py"/>
        <source>the machine file has no controller.speed_unit; add it</source>
        <translation>le fichier machine n&apos;a pas de controller.speed_unit ; ajoutez-le</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/order.py"/>
        <source>the machine waits before {0} of {1} layers, up to {2} s and {3} s in all, so that no layer takes less than {4} s</source>
        <translation>la machine attend avant {0} des {1} couches, jusqu&apos;à {2} s et {3} s au total, afin qu&apos;aucune couche ne dure moins de {4} s</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/solids/notes.py"/>
        <source>the machine waits before {0} of {1} layers, up to {2} s and {3} s in all, so that no layer takes less than {4} s and no solid is returned to sooner than after {5} s</source>
        <translation>la machine attend avant {0} couches sur {1}, jusqu&apos;à {2} s et {3} s en tout, afin qu&apos;aucune couche ne dure moins de {4} s et qu&apos;on ne revienne à aucun solide avant {5} s</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/solids/notes.py"/>
        <source>the machine waits before {0} of {1} layers, up to {2} s and {3} s in all, so that no solid is returned to sooner than after {4} s</source>
        <translation>la machine attend avant {0} de {1} couches, jusqu&apos;à {2} s et {3} s en tout, pour qu&apos;on ne revienne à aucun solide avant {4} s</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/model/material.py"/>
        <source>the material</source>
        <translation>le matériau</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/machine.py"/>
        <source>the matrix has no inverse; give that of the controller</source>
        <translation>la matrice n&apos;a pas d&apos;inverse ; donnez celle de la commande</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/point_file.py"/>
        <source>the measured points cannot be read ({0}); check the path</source>
        <translation>les points mesurés ne peuvent pas être lus ({0}) ; vérifiez le chemin</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/registration.py"/>
        <source>the measured points do not settle on the part; give pairs of points to begin with</source>
        <translation>les points mesurés ne se posent pas sur la pièce ; donnez des paires de points pour commencer</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/mesh/repair.py"/>
        <source>the mesh encloses nothing; export the solid again</source>
        <translation>le maillage n&apos;enferme rien ; exportez le solide de nouveau</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/mesh/solid.py"/>
        <source>the mesh has a hole</source>
        <translation>le maillage a un trou</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/mesh/repair.py"/>
        <source>the mesh has a hole: {0} edges, {1} mm across, at {2}, and {3} more; fill holes (Mesh, Close holes) or export it again, or deposit it as a wall if it is one</source>
        <translation>le maillage a un trou : {0} arêtes, {1} mm de large, en {2}, et {3} de plus ; remplissez les trous (Mesh, Remplir les trous) ou exportez-le à nouveau, ou déposez-le comme paroi si c&apos;en est une</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/mesh/repair.py"/>
        <source>the mesh has a hole: {0} edges, {1} mm across, at {2}, and {3} more; up to strategy.mend, {4} mm, holes are closed; fill holes (Mesh, Close holes) or export it again, or deposit it as a wall if it is one</source>
        <translation>le maillage a un trou : {0} arêtes, {1} mm de large, en {2}, et {3} de plus ; jusqu&apos;à strategy.mend, {4} mm, les trous sont fermés ; remplissez les trous (Mesh, Remplir les trous) ou exportez-le à nouveau, ou déposez-le comme paroi si c&apos;en est une</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/mesh/repair.py"/>
        <source>the mesh has a hole: {0} edges, {1} mm across, at {2}; fill holes (Mesh, Close holes) or export it again, or deposit it as a wall if it is one</source>
        <translation>le maillage a un trou : {0} arêtes, {1} mm de large, en {2} ; remplissez les trous (Mesh, Remplir les trous) ou exportez-le à nouveau, ou déposez-le comme paroi si c&apos;en est une</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/mesh/repair.py"/>
        <source>the mesh has a hole: {0} edges, {1} mm across, at {2}; up to strategy.mend, {3} mm, holes are closed; fill holes (Mesh, Close holes) or export it again, or deposit it as a wall if it is one</source>
        <translation>le maillage a un trou : {0} arêtes, {1} mm de large, en {2} ; jusqu&apos;à strategy.mend, {3} mm, les trous sont fermés ; remplissez les trous (Mesh, Remplir les trous) ou exportez-le à nouveau, ou déposez-le comme paroi si c&apos;en est une</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/mesh/orientation.py"/>
        <source>the mesh has no inside, as at {0}; model the solid again</source>
        <translation>le maillage n&apos;a pas d&apos;intérieur, comme en {0} ; modélisez le solide de nouveau</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/mesh/repair.py"/>
        <source>the mesh has no triangles, or points that are not numbers; export it again</source>
        <translation>le maillage n&apos;a pas de triangles, ou des points qui ne sont pas des nombres ; exportez-le de nouveau</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/substrate.py"/>
        <source>the mesh has no triangles; choose a closed mesh or a solid part</source>
        <translation>le maillage n&apos;a pas de triangles ; choisissez un maillage fermé ou une pièce solide</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/substrate.py"/>
        <source>the mesh has points that are not numbers; export it again</source>
        <translation>le maillage a des points qui ne sont pas des nombres ; exportez-le de nouveau</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/kuka/read.py"/>
        <source>the module does not set all that the move counts on</source>
        <translation>le module ne règle pas tout ce sur quoi compte le mouvement</translation>
    </message>
    <message>
        <location filename="../../freecad_am/read_back/switched.py"/>
        <source>the move at the end of which the deposit is switched takes {0} s, less than the {1} s that it would be switched ahead; use a program.trigger.lead no longer than that, a larger retract distance where it is switched on, or a larger strategy.chord_error where it is switched off</source>
        <translation>le mouvement à la fin duquel le dépôt est commuté dure {0} s, moins que les {1} s d&apos;avance de la commutation ; utilisez un program.trigger.lead qui ne dépasse pas cette durée, une plus grande distance de retrait là où il est enclenché, ou une plus grande strategy.chord_error là où il est coupé</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/refusals.py"/>
        <source>the move at the end of which the deposit is switched takes {0} s, less than the {1} s that it would be switched ahead; use a program.trigger.lead of {2} s at most, a larger retract distance where it is switched on, or a larger strategy.chord_error where it is switched off</source>
        <translation>le mouvement à la fin duquel le dépôt est commuté dure {0} s, moins que les {1} s d’avance de la commutation ; utilisez un program.trigger.lead d’au plus {2} s, une plus grande distance de retrait là où il est enclenché, ou une plus grande strategy.chord_error là où il est coupé</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/kuka/read.py"/>
        <source>the move before it is to be approximated, and it stops there</source>
        <translation>le mouvement qui précède doit être lissé, et s&apos;arrête là</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/nc/read.py"/>
        <source>the move is not given in the axes of the first one</source>
        <translation>le mouvement n&apos;est pas dit dans les axes du premier</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/yaskawa/read.py"/>
        <source>the move {0} is not understood, or its position is not there</source>
        <translation>le mouvement {0} n&apos;est pas compris, ou sa position n&apos;existe pas</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/post.py"/>
        <source>the name of its mechanical unit, such as STN1</source>
        <translation>le nom de son unité mécanique, comme STN1</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/yaskawa/post.py"/>
        <source>the name of its station, such as ST1</source>
        <translation>le nom de sa station, par exemple ST1</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/texts/touching.py"/>
        <source>the nozzle</source>
        <translation>la buse</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/clearance.py"/>
        <source>the nozzle as a cone at {0} points, against platform, part and what is deposited by then; beads as wide and high as they count</source>
        <translation>la buse comme un cône en {0} points, face au plateau, à la pièce et à ce qui est déposé à ce moment ; cordons de la largeur et de la hauteur qui comptent</translation>
    </message>
    <message>
        <location filename="../../freecad_am/read_back/into_platform.py"/>
        <source>the nozzle deposits at 1 point below the platform, by {0} mm; correct its height, or the cell&apos;s platform</source>
        <translation>la buse dépose à 1 point sous le plateau, de {0} mm ; corrigez sa hauteur, ou le plateau de la cellule</translation>
    </message>
    <message>
        <location filename="../../freecad_am/read_back/into_platform.py"/>
        <source>the nozzle deposits at {0} points below the platform, here {1} mm; correct their heights, or the cell&apos;s platform</source>
        <translation>la buse dépose à {0} points sous le plateau, ici de {1} mm ; corrigez leurs hauteurs, ou le plateau de la cellule</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/upright.py"/>
        <source>the nozzle is not clear with {0} either, which was tried</source>
        <translation>la buse n&apos;est pas dégagée avec {0} non plus, ce qui a été essayé</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/readout.py"/>
        <source>the nozzle touches platform or part</source>
        <translation>la buse touche le plateau ou la pièce</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/clearance/look.py"/>
        <source>the nozzle touches {0} at {1} of {2} points; on parts of revolution it is not tilted away from fixtures: move them, or use a slimmer nozzle</source>
        <translation>la buse touche {0} en {1} de {2} points ; sur les pièces de révolution elle n&apos;est pas écartée des montages : déplacez-les, ou utilisez une buse plus fine</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/arm/kept.py"/>
        <source>the nozzle touches {0} on the rapid way to the bead; lift the part over it by cell.platform, or move it in cell.external</source>
        <translation>la buse touche {0} pendant le déplacement rapide vers le cordon ; relevez la pièce au-dessus par cell.platform, ou déplacez-le dans cell.external</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/arm/kept.py"/>
        <source>the nozzle touches {0} on the rapid way to the bead; move it in cell.obstacles, the part or cell.deposition_point</source>
        <translation>la buse touche {0} pendant le déplacement rapide vers le cordon ; déplacez-le dans cell.obstacles, la pièce ou cell.deposition_point</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/nozzle_obstacles.py"/>
        <source>the nozzle touches {0} on {1} move(s) while it deposits; lift the part over it by cell.platform, or move it in cell.external</source>
        <translation>la buse touche {0} sur {1} mouvement(s) pendant qu’elle dépose ; relevez la pièce au-dessus par cell.platform, ou déplacez-le dans cell.external</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/nozzle_obstacles.py"/>
        <source>the nozzle touches {0} on {1} move(s) while it deposits; move it in cell.obstacles, or the part</source>
        <translation>la buse touche {0} sur {1} mouvement(s) pendant le dépôt ; déplacez-le dans cell.obstacles, ou la pièce</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/arm/kept.py"/>
        <source>the nozzle touches {0}; lift the part over it by cell.platform, or move it in cell.external</source>
        <translation>la buse touche {0} ; relevez la pièce au-dessus par cell.platform, ou déplacez-le dans cell.external</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/arm/kept.py"/>
        <source>the nozzle touches {0}; move it in cell.obstacles, the part or cell.deposition_point</source>
        <translation>la buse touche {0} ; déplacez-le dans cell.obstacles, la pièce ou cell.deposition_point</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/texts/touching.py"/>
        <source>the nozzle touches {what}</source>
        <translation>la buse touche {what}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/refusals.py"/>
        <source>the number of a schedule is set on one of 1 to {0}, not {1}; use one of these</source>
        <translation>le numéro d&apos;un programme de soudage est mis sur une sortie de 1 à {0}, non {1} ; prenez l&apos;une d&apos;elles</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/kuka/post.py"/>
        <source>the number of its MACHINE_DEF, 2 to 16</source>
        <translation>le numéro de son MACHINE_DEF, de 2 à 16</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/registration.py"/>
        <source>the pairs of points lie in one line, about which the part can turn; choose others</source>
        <translation>les paires de points sont sur une ligne, autour de laquelle la pièce peut tourner ; choisissez-en d&apos;autres</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/arm/kept.py"/>
        <source>the part comes nearer than {0} mm to {1}, or touches it on the rapid way to the bead; move one of them in cell.external or the part, try another cell.branch, or lower cell.arm_clearance</source>
        <translation>la pièce s’approche à moins de {0} mm de {1}, ou le touche, pendant le déplacement rapide vers le cordon ; déplacez l’un d’eux dans cell.external, ou la pièce, essayez une autre cell.branch, ou diminuez cell.arm_clearance</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/arm/kept.py"/>
        <source>the part comes nearer than {0} mm to {1}, or touches it on the rapid way to the bead; move the part or cell.deposition_point, try another cell.branch, or lower cell.arm_clearance</source>
        <translation>la pièce s&apos;approche à moins de {0} mm de {1}, ou le touche, pendant le déplacement rapide vers le cordon ; déplacez la pièce ou cell.deposition_point, essayez un autre cell.branch, ou diminuez cell.arm_clearance</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/arm/kept.py"/>
        <source>the part comes nearer than {0} mm to {1}, or touches it; move one of them in cell.external or the part, try another cell.branch, or lower cell.arm_clearance</source>
        <translation>la pièce s’approche à moins de {0} mm de {1}, ou le touche ; déplacez l’un d’eux dans cell.external, ou la pièce, essayez une autre cell.branch, ou diminuez cell.arm_clearance</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/arm/kept.py"/>
        <source>the part comes nearer than {0} mm to {1}, or touches it; move the part or cell.deposition_point, try another cell.branch, or lower cell.arm_clearance</source>
        <translation>la pièce s&apos;approche à moins de {0} mm de {1}, ou le touche ; déplacez la pièce ou cell.deposition_point, essayez un autre cell.branch, ou diminuez cell.arm_clearance</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/checks/predicted_shape.py"/>
        <source>the part has no faces above where the deposit begins; choose another part</source>
        <translation>la pièce n&apos;a pas de faces au-dessus du début du dépôt ; choisissez une autre pièce</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/fit_layers.py"/>
        <source>the part has too few layers to lead back to the plan: the last one is up to {0} mm off it; a larger substrate.scan_band leads back in fewer layers</source>
        <translation>la pièce a trop peu de couches pour ramener au plan : la dernière en est éloignée de {0} mm au plus ; un substrate.scan_band plus grand y ramène en moins de couches</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/texts/touching.py"/>
        <source>the part touches {what}</source>
        <translation>la pièce touche {what}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/simulation/payload.py"/>
        <source>the part weighs more than {0} kg from here on, {1} kg when it is finished, {2} kg of which it grows on, and {3} carries no more; {4}</source>
        <translation>la pièce pèse plus de {0} kg à partir d&apos;ici, {1} kg une fois finie, dont {2} kg de ce sur quoi elle pousse, et {3} ne porte pas plus ; {4}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/controls.py"/>
        <source>the path</source>
        <translation>la trajectoire</translation>
    </message>
    <message>
        <location filename="../../freecad_am/verify.py"/>
        <source>the path between two points leaves the straight line by {0} mm, more than the chord error</source>
        <translation>la trajectoire entre deux points quitte la droite de {0} mm, plus que l&apos;erreur de corde</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/written.py"/>
        <source>the path of the text between its points, as the controller interpolates it</source>
        <translation>la trajectoire du texte entre ses points, comme la commande l’interpole</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/slicing/tubes/normal_layers.py"/>
        <source>the planes normal to its centreline do not cut it in one curve each; choose other layers for this wall</source>
        <translation>les plans normaux à sa ligne médiane ne la coupent pas en une courbe chacun ; choisissez d&apos;autres couches pour cette paroi</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/texts/touching.py"/>
        <source>the platform</source>
        <translation>le plateau</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/curves/curve_table.py"/>
        <source>the point is that of the line before; leave it out</source>
        <translation>le point est celui de la ligne d&apos;avant ; enlevez-le</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/work_offset.py"/>
        <source>the points of the part are on a line, or all in one place: they leave open how the part is turned about it; touch one off that line</source>
        <translation>les points de la pièce sont sur une droite, ou tous au même endroit : rien ne dit comment la pièce est tournée autour ; palpez-en un à côté</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/staubli/moves.py"/>
        <source>the points of {0} are not all in one frame</source>
        <translation>les points de {0} ne sont pas tous dans un repère</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/inspect.py"/>
        <source>the points reach over {0} mm, {1} over {2} mm; check the unit of the file</source>
        <translation>les points s&apos;étendent sur {0} mm, {1} sur {2} mm ; vérifiez l&apos;unité du fichier</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/work_offset.py"/>
        <source>the points touched are on a line, or all in one place: they leave open how the part is turned about it; touch one off that line</source>
        <translation>les points palpés sont sur une droite, ou tous au même endroit : rien ne dit comment la pièce est tournée autour ; palpez-en un à côté</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/check_poses.py"/>
        <source>the pose at all zeros is missing; add it</source>
        <translation>la pose à zéro de tous les axes manque ; ajoutez-le</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/poses_page.py"/>
        <source>the pose at the serial zeros is missing; enter it too</source>
        <translation>la pose aux zéros en série manque ; saisissez-la aussi</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/findings.py"/>
        <source>the positioner is out of the robot&apos;s reach: the nearest point of the part is {0} mm from the shoulder, arm and tool stretch {1} mm at most; put the positioner nearer (cell.external)</source>
        <translation>le positionneur est hors d&apos;atteinte du robot : le point de la pièce le plus proche est à {0} mm de l&apos;épaule, bras et outil s&apos;étendent à {1} mm au plus ; rapprochez le positionneur (cell.external)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/post.py"/>
        <source>the post abb cannot write {0} ({1} motion); use another post</source>
        <translation>le post-processeur abb ne peut pas écrire {0} (mouvement {1}) ; utilisez un autre post-processeur</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/fanuc/post.py"/>
        <source>the post fanuc cannot write {0}; use another post</source>
        <translation>le post-processeur fanuc ne peut pas écrire {0} ; utilisez un autre post-processeur</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/kuka/post.py"/>
        <source>the post kuka cannot write {0}; use another post</source>
        <translation>le post-processeur kuka ne peut pas écrire {0} ; utilisez un autre post-processeur</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/staubli/post.py"/>
        <source>the post staubli cannot write {0} ({1} motion); use another post</source>
        <translation>le post-processeur staubli ne peut pas écrire {0} (mouvement {1}) ; utilisez un autre post-processeur</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/ur/post.py"/>
        <source>the post ur cannot write {0}; use another post</source>
        <translation>le post-processeur ur ne peut pas écrire {0} ; utilisez un autre post-processeur</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/yaskawa/post.py"/>
        <source>the post yaskawa cannot write {0}; use another post</source>
        <translation>le post-processeur yaskawa ne peut pas écrire {0} ; utilisez un autre post-processeur</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/nc/parts.py"/>
        <source>the post {0} cannot write {1} ({2} motion); use rotary-table</source>
        <translation>le post-processeur {0} ne peut pas écrire {1} (mouvement {2}) ; utilisez rotary-table</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/nc/parts.py"/>
        <source>the post {0} writes linear axes X Y Z and rotary axes of A B C, one each; the machine has {1}: name its joints mx my mz and a, b or c</source>
        <translation>le post-processeur {0} écrit des axes linéaires X Y Z et des axes rotatifs parmi A B C, un de chaque ; la machine a {1} : nommez ses articulations mx my mz et a, b ou c</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/refusals.py"/>
        <source>the post {0} writes {1} axes; use another post</source>
        <translation>le post-processeur {0} écrit {1} axes ; utilisez un autre post-processeur</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/ur/post.py"/>
        <source>the program does not say where the flange is, which blends depend on; plan the joint path again</source>
        <translation>le programme ne dit pas où est la bride, dont dépendent les lissages ; replanifiez la trajectoire articulaire</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/fanuc/numbers.py"/>
        <source>the program has no arm configurations; use `motion: joint`</source>
        <translation>le programme n&apos;a pas de configurations de bras ; utilisez `motion: joint`</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/program.py"/>
        <source>the program has no name; give one</source>
        <translation>le programme n&apos;a pas de nom ; donnez-en un</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/post.py"/>
        <source>the program has no positions; use `motion: joint`</source>
        <translation>le programme n&apos;a pas de positions ; utilisez `motion: joint`</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/refusals.py"/>
        <source>the program holds no moves; check where it starts</source>
        <translation>le programme ne contient pas de mouvements ; vérifiez où il commence</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/yaskawa/read.py"/>
        <source>the pulses per {0} of {1} differ, or are none</source>
        <translation>les impulsions par {0} de {1} diffèrent, ou sont nulles</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/fanuc/records.py"/>
        <source>the record of P[{0}] is not understood</source>
        <translation>l&apos;enregistrement de P[{0}] n&apos;est pas compris</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/filling/centre.py"/>
        <source>the region at {0} is {1} mm wide, less than a bead ({2} mm); choose thin = single, a narrower bead or a margin</source>
        <translation>la région en {0} est large de {1} mm, moins qu&apos;un cordon ({2} mm) ; choisissez thin = single, un cordon plus étroit ou une marge</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/rapids/findings.py"/>
        <source>the retract before or after the bead cannot be reached at any height, direction or rotation tried; lower process.between_layers.lift or move the part in the cell</source>
        <translation>le retrait avant ou après le cordon est hors d&apos;atteinte à chaque hauteur, direction ou rotation essayée ; diminuez process.between_layers.lift ou déplacez la pièce dans la cellule</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/modules.py"/>
        <source>the robot has to carry either the tool or the work object</source>
        <translation>le robot doit porter soit l&apos;outil, soit l&apos;objet de travail</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/findings.py"/>
        <source>the rotation about the tool axis would be {0} deg, outside the range allowed</source>
        <translation>la rotation autour de l&apos;axe de l&apos;outil serait de {0} deg, hors de la plage permise</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/fields/pendants.py"/>
        <source>the rotation vector is {0} rad long, more than a turn; give RX RY RZ in rad, as the pendant shows them</source>
        <translation>le vecteur de rotation a une longueur de {0} rad, plus d&apos;un tour ; donnez RX RY RZ en rad, comme le pupitre les affiche</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/fit_layers.py"/>
        <source>the scan lies {0} mm from layer {1} at {2}, more than substrate.scan_within = {3} mm; check that it is of this part, its unit and its fit</source>
        <translation>la numérisation est à {0} mm de la couche {1} en {2}, plus que substrate.scan_within = {3} mm ; vérifiez qu&apos;elle est de cette pièce, son unité et son ajustement</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/scan_checks.py"/>
        <source>the scan reaches over {0} mm, {1} over {2} mm; check its unit, substrate.scan_unit, and what was scanned</source>
        <translation>la numérisation s&apos;étend sur {0} mm, {1} sur {2} mm ; vérifiez son unité, substrate.scan_unit, et ce qui a été numérisé</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/scan_checks.py"/>
        <source>the scan reaches over {0} mm, {1} over {2} mm; in {3} it would be about as large, give that as substrate.scan_unit</source>
        <translation>la numérisation s&apos;étend sur {0} mm, {1} sur {2} mm ; en {3} elle serait à peu près aussi grande, donnez cela comme substrate.scan_unit</translation>
    </message>
    <message>
        <location filename="../../freecad_am/read_back/events.py"/>
        <source>the schedule that is sent is not the planned one</source>
        <translation>un autre programme de soudage que prévu est transmis</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/turns/unwrap.py"/>
        <source>the seams of {0} beads were moved to keep an axis within its limits</source>
        <translation>les coutures de {0} cordons ont été déplacées pour garder un axe dans ses limites</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/fanuc/records.py"/>
        <source>the second group of P[{0}] is not understood</source>
        <translation>le deuxième groupe de P[{0}] n&apos;est pas compris</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/machine.py"/>
        <source>the set {0} is missing; add it</source>
        <translation>le jeu {0} manque ; ajoutez-le</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/revolution/wall.py"/>
        <source>the shape is empty; choose an object with a shape</source>
        <translation>la forme est vide ; choisissez un objet qui a une forme</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/feature.py"/>
        <source>the shape to deposit, or some of its faces</source>
        <translation>la forme à déposer, ou certaines de ses faces</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/substrate.py"/>
        <source>the solid around {0} is turned inside out (volume {1} mm3); repair it (Part, Check geometry), or turn it (Part, Reverse shapes)</source>
        <translation>le solide autour de {0} est retourné (volume {1} mm3) ; réparez-le (Part, Vérifier la géométrie), ou inversez-le (Part, Inverser les formes)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/layers/along/centre_line.py"/>
        <source>the solid ends after one section</source>
        <translation>le solide finit après une section</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/mesh/solid.py"/>
        <source>the solid is turned inside out (volume {0} mm3, near {1}); flip its normals (Mesh, Flip normals)</source>
        <translation>le solide est retourné (volume {0} mm3, près de {1}) ; inversez ses normales (Mesh, Inverser les normales)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/first_layer.py"/>
        <source>the solid is turned inside out; repair it (Part, Check geometry)</source>
        <translation>le solide est retourné ; réparez-le (Part, Vérifier la géométrie)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/layers/rotary/field.py"/>
        <source>the solid reaches over the end of the hub&apos;s axis, at {0}, where equidistant surfaces have an apex or an end; let it end beside the axis</source>
        <translation>le solide dépasse la fin de l&apos;axe du moyeu, en {0}, là où les surfaces équidistantes ont un sommet ou une fin ; faites-le finir à côté de l&apos;axe</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/mesh/solid.py"/>
        <source>the solid touches itself along an edge, so that its inside is not known</source>
        <translation>le solide se touche lui-même le long d’une arête, si bien que son intérieur est inconnu</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/solid_feature.py"/>
        <source>the solids or closed meshes to deposit</source>
        <translation>les solides ou maillages fermés à déposer</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/developable_feature.py"/>
        <source>the solids or closed meshes to deposit; or a part and the faces of its hub, where both are one solid</source>
        <translation>les solides ou maillages fermés à déposer ; ou une pièce et les faces de son moyeu, si les deux sont un seul solide</translation>
    </message>
    <message>
        <location filename="../../freecad_am/read_back/times.py"/>
        <source>the speed in the text is not the planned one</source>
        <translation>la vitesse dans le texte n&apos;est pas celle planifiée</translation>
    </message>
    <message>
        <location filename="../../freecad_am/read_back/events.py"/>
        <source>the speed of the wire in the text is not the planned one</source>
        <translation>la vitesse du fil dans le texte n&apos;est pas celle planifiée</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/yaskawa/read.py"/>
        <source>the speed {0} is none</source>
        <translation>la vitesse {0} n&apos;en est pas une</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/results/store.py"/>
        <source>the stored result cannot be read ({0}); recompute it</source>
        <translation>le résultat enregistré ne peut pas être lu ({0}) ; recalculez-le</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/model/notes.py"/>
        <source>the table was measured at a wire feed of {0} mm/s, the job has {1} mm/s; set process.wire.feed to auto or to that, or measure a table at it</source>
        <translation>le tableau a été mesuré avec un dévidage de {0} mm/s, le travail a {1} mm/s ; mettez process.wire.feed à auto ou à cette valeur, ou mesurez un tableau avec celle du travail</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/model/notes.py"/>
        <source>the table was measured at a wire feed of {0} to {1} mm/s, the job has {2} mm/s; set process.wire.feed to auto or to that, or measure a table at it</source>
        <translation>la table a été mesurée à une vitesse de fil de {0} à {1} mm/s, le travail a {2} mm/s ; mettez process.wire.feed à auto ou à une de celles-ci, ou mesurez une table à cette vitesse</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/tree.py"/>
        <source>the tag {0} is not allowed here; write the plain value</source>
        <translation>la balise {0} n&apos;est pas admise ici ; écrivez la valeur simple</translation>
    </message>
    <message>
        <location filename="../../freecad_am/read_back/ways.py"/>
        <source>the text asks for another configuration of the arm, or other turns</source>
        <translation>le texte demande une autre configuration du bras, ou d&apos;autres tours</translation>
    </message>
    <message>
        <location filename="../../freecad_am/read_back/ways.py"/>
        <source>the text asks for joint values other than the planned ones</source>
        <translation>le texte demande d&apos;autres valeurs articulaires que celles prévues</translation>
    </message>
    <message>
        <location filename="../../freecad_am/read_back/points.py"/>
        <source>the text gives another position there than the joint values</source>
        <translation>le texte y dit une autre position que les valeurs articulaires</translation>
    </message>
    <message>
        <location filename="../../freecad_am/verify.py"/>
        <source>the text has {0} moves, planned are {1}</source>
        <translation>le texte a {0} mouvements, {1} sont planifiés</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/tree.py"/>
        <source>the text is not UTF-8 (line {0}); save it as UTF-8</source>
        <translation>le texte n&apos;est pas en UTF-8 (ligne {0}) ; enregistrez-le en UTF-8</translation>
    </message>
    <message>
        <location filename="../../freecad_am/read_back/points.py"/>
        <source>the text leads up to {0} mm away from the planned point, more than its digits explain</source>
        <translation>le texte mène jusqu&apos;à {0} mm du point planifié, plus que ses chiffres n&apos;expliquent</translation>
    </message>
    <message>
        <location filename="../../freecad_am/read_back/ways.py"/>
        <source>the text moves straight in space where straight in the joints was planned, or the other way</source>
        <translation>le texte va droit dans l&apos;espace où il était planifié d&apos;aller droit dans les articulations, ou l&apos;inverse</translation>
    </message>
    <message>
        <location filename="../../freecad_am/read_back/ways.py"/>
        <source>the text moves {0} from axis {1} on, the program {2} from axis {3} on</source>
        <translation>le texte déplace {0} à partir de l&apos;axe {1}, le programme {2} à partir de l&apos;axe {3}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/read_back/ways.py"/>
        <source>the text names configurations of an arm, and the machine has none</source>
        <translation>le texte nomme des configurations d&apos;un bras, et la machine n&apos;en a pas</translation>
    </message>
    <message>
        <location filename="../../freecad_am/read_back/ways.py"/>
        <source>the text selects another frame or tool than {0} and {1}</source>
        <translation>le texte choisit un autre repère ou outil que {0} et {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/read_back/ways.py"/>
        <source>the text stops, or rounds the corner, otherwise than planned</source>
        <translation>le texte s&apos;arrête, ou arrondit l&apos;angle, autrement que planifié</translation>
    </message>
    <message>
        <location filename="../../freecad_am/read_back/points.py"/>
        <source>the text takes {0} up to {1} {2} beyond its limit</source>
        <translation>le texte mène {0} jusqu&apos;à {1} {2} au-delà de sa limite</translation>
    </message>
    <message>
        <location filename="../../freecad_am/read_back/times.py"/>
        <source>the time in the text does not give the planned speed</source>
        <translation>le temps dans le texte ne donne pas la vitesse planifiée</translation>
    </message>
    <message>
        <location filename="../../freecad_am/read_back/times.py"/>
        <source>the times of a bead do not add up to the planned one</source>
        <translation>les temps d&apos;un cordon ne font pas la somme planifiée</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/process.py"/>
        <source>the tip moves at {0} mm/s on the move at the end of which the deposit is switched, and the lead is programmed as a distance before that place; give a retract distance, or leave program.trigger.lead out</source>
        <translation>la pointe avance à {0} mm/s dans le mouvement à la fin duquel le dépôt est commuté, et l&apos;on indique au contrôleur à quelle distance de cette fin ; donnez une distance de retrait, ou omettez program.trigger.lead</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/external/level.py"/>
        <source>the tool axis would be {0} deg from the vertical, build_direction.max_from_vertical allows {1} deg, and nothing turns the part; put it on a positioner, or allow more</source>
        <translation>l&apos;axe de l&apos;outil serait à {0} deg de la verticale, build_direction.max_from_vertical permet {1} deg, et rien ne tourne la pièce ; mettez-la sur un positionneur, ou permettez plus</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/external/level.py"/>
        <source>the tool axis would be {0} deg from the vertical, build_direction.max_from_vertical allows {1} deg; the positioner cannot turn the part so far: mount the part otherwise, or allow more</source>
        <translation>l&apos;axe de l&apos;outil serait à {0} deg de la verticale, build_direction.max_from_vertical permet {1} deg ; le positionneur ne peut pas tourner la pièce autant : montez la pièce autrement, ou permettez plus</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/ur/numbers.py"/>
        <source>the tool goes {0} mm past a point that is not stopped at, too little for a blend radius, and the robot would stop there with the deposit on; use a larger strategy.chord_error, or `program.blend: 0` to stop at every point</source>
        <translation>l&apos;outil parcourt {0} mm près d&apos;un point sans arrêt, trop peu pour un rayon de lissage, et le robot s&apos;y arrêterait en déposant ; utilisez un strategy.chord_error plus grand, ou `program.blend: 0` pour s&apos;arrêter à chaque point</translation>
    </message>
    <message>
        <location filename="../../freecad_am/read_back/points.py"/>
        <source>the tool is tilted by up to {0} deg, more than the digits explain</source>
        <translation>l&apos;outil est incliné jusqu&apos;à {0} deg, plus que les chiffres n&apos;expliquent</translation>
    </message>
    <message>
        <location filename="../../freecad_am/verify.py"/>
        <source>the tool is turned otherwise than planned</source>
        <translation>l&apos;outil est tourné autrement que planifié</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/joint_path.py"/>
        <source>the toolpath to run</source>
        <translation>la trajectoire d&apos;outil à exécuter</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/staubli/moves.py"/>
        <source>the tools of {0} are not all on one tool</source>
        <translation>les outils de {0} ne sont pas tous sur un outil</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/texts/touching.py"/>
        <source>the torch</source>
        <translation>la torche</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/arm/kept.py"/>
        <source>the torch comes nearer than {0} mm to {1}, or touches it on the rapid way to the bead; move one of them in cell.external or the part, try another cell.branch, or lower cell.arm_clearance</source>
        <translation>la torche s’approche à moins de {0} mm de {1}, ou le touche, pendant le déplacement rapide vers le cordon ; déplacez l’un d’eux dans cell.external, ou la pièce, essayez une autre cell.branch, ou diminuez cell.arm_clearance</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/arm/kept.py"/>
        <source>the torch comes nearer than {0} mm to {1}, or touches it on the rapid way to the bead; move the part or cell.deposition_point, try another cell.branch, or lower cell.arm_clearance</source>
        <translation>la torche s&apos;approche à moins de {0} mm de {1}, ou touche cet objet, sur le déplacement rapide vers le cordon ; déplacez la pièce ou cell.deposition_point, essayez une autre cell.branch, ou diminuez cell.arm_clearance</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/arm/kept.py"/>
        <source>the torch comes nearer than {0} mm to {1}, or touches it; move one of them in cell.external or the part, try another cell.branch, or lower cell.arm_clearance</source>
        <translation>la torche s’approche à moins de {0} mm de {1}, ou le touche ; déplacez l’un d’eux dans cell.external, ou la pièce, essayez une autre cell.branch, ou diminuez cell.arm_clearance</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/arm/kept.py"/>
        <source>the torch comes nearer than {0} mm to {1}, or touches it; move the part or cell.deposition_point, try another cell.branch, or lower cell.arm_clearance</source>
        <translation>la torche s&apos;approche à moins de {0} mm de {1}, ou touche cet objet ; déplacez la pièce ou cell.deposition_point, essayez une autre cell.branch, ou diminuez cell.arm_clearance</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/texts/touching.py"/>
        <source>the torch touches {what}</source>
        <translation>la torche touche {what}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/siemens/read.py"/>
        <source>the transformation changes while the deposit is on</source>
        <translation>la transformation change pendant que le dépôt est en marche</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/checks/controllers.py"/>
        <source>the unit of V is a setting of the controller of {0}, and another one is another speed; give controller.speed_unit in a machine file of your own, or use `motion: joint`</source>
        <translation>l&apos;unité de V est un réglage de la commande de {0}, et une autre unité est une autre vitesse ; donnez controller.speed_unit dans un fichier machine à vous, ou utilisez `motion: joint`</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/modules.py"/>
        <source>the value of {0} is not understood</source>
        <translation>la valeur de {0} n&apos;est pas comprise</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/staubli/files.py"/>
        <source>the values of {0} are not those from 0 to its size, each once</source>
        <translation>les valeurs de {0} ne sont pas celles de 0 à sa taille, chacune une fois</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/point_file.py"/>
        <source>the vertices of a mesh are taken as points</source>
        <translation>les sommets d&apos;un maillage sont pris comme points</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/surface_feature.py"/>
        <source>the wall and what it grows on are the same, {0}; choose the part that is there before it, or none where the wall starts on the platform or from edges</source>
        <translation>la paroi et ce sur quoi elle croît sont la même pièce, {0} ; choisissez la pièce qui est là avant elle, ou aucune si la paroi commence sur la plateforme ou à des arêtes</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/wall.py"/>
        <source>the wall bends too sharply: {0} mm off between {1} x {2} samples; smooth it, or cut it where it has an edge</source>
        <translation>la paroi se courbe trop fort : {0} mm d&apos;écart entre {1} x {2} échantillons ; lissez-la, ou coupez-la là où elle a une arête</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/cuts.py"/>
        <source>the wall cuts itself at {0} ({1}); give bends a larger radius than the tube, and let no faces cross</source>
        <translation>la paroi se coupe elle-même en {0} ({1}) ; donnez aux coudes un rayon plus grand que celui du tube, et ne laissez aucune face en croiser une autre</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/walls/mesh_wall.py"/>
        <source>the wall cuts itself: {0} pairs of its triangles cross, for instance at {1}; repair the mesh (Mesh, Analyze, Self-intersections), or deposit it as a solid, with holes of up to strategy.mend closed</source>
        <translation>la paroi se coupe elle-même : {0} paires de ses triangles se croisent, par exemple en {1} ; réparez le maillage (Mesh, Analyser, Auto-intersections), ou déposez-le comme solide, les trous jusqu&apos;à strategy.mend étant fermés</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/slicing/first_layer.py"/>
        <source>the wall does not come out of the substrate everywhere (at v = {0}, for instance): let it reach into the substrate all around, or choose the edges it starts from</source>
        <translation>la paroi ne sort pas partout du substrat (en v = {0}, par exemple) : faites-la pénétrer dans le substrat sur tout le tour, ou choisissez les arêtes de départ</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/first_layer.py"/>
        <source>the wall does not meet {0} in a closed curve (nearest {1} mm); let it reach into it all around</source>
        <translation>la paroi ne rencontre pas {0} en une courbe fermée (au plus près {1} mm) ; faites-la pénétrer sur tout le tour</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/patch_wall.py"/>
        <source>the wall does not touch {0}: it comes nearest at {1}, {2} mm away; move it so that it reaches in, at most {3} mm may be missing</source>
        <translation>la paroi ne touche pas {0} : elle en est au plus près en {1}, à {2} mm ; déplacez-la pour qu&apos;elle y pénètre, il peut manquer {3} mm au plus</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/slicing/tubes/smooth_spacing.py"/>
        <source>the wall has no point at {0} mm from the layer below: use a smaller layer height or a narrower band</source>
        <translation>la paroi n&apos;a pas de point à {0} mm de la couche du dessous : prenez une plus petite hauteur de couche ou une bande plus étroite</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/patch_wall.py"/>
        <source>the wall lies wholly in {0} (at {1} it is {2} mm deep, and nowhere less); let it end outside of the substrate</source>
        <translation>la paroi est tout entière dans {0} (en {1} à {2} mm de profondeur, et nulle part moins) ; faites-la finir hors du substrat</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/patch_wall.py"/>
        <source>the wall meets {0} in no curve that a layer can start from (shorter than a few {1} mm); let it reach in all around, or choose the edges to start from</source>
        <translation>la paroi ne rencontre {0} en aucune courbe d&apos;où une couche puisse partir (plus courte que quelques fois {1} mm) ; faites-la pénétrer sur tout le tour, ou choisissez les arêtes de départ</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/surface_feature.py"/>
        <source>the wall to deposit, or its faces</source>
        <translation>la paroi à déposer, ou ses faces</translation>
    </message>
    <message>
        <location filename="../../freecad_am/verify.py"/>
        <source>the way between two beads leaves the one that was checked by up to {0} mm</source>
        <translation>le chemin entre deux cordons s&apos;écarte jusqu&apos;à {0} mm de celui qui a été vérifié</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/nc/read.py"/>
        <source>the way of the move, and so its time, is not known</source>
        <translation>le chemin du mouvement, et donc son temps, n&apos;est pas connu</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/read_process.py"/>
        <source>the weave is another one within a bead</source>
        <translation>le balayage change au sein d&apos;un cordon</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/kuka/post.py"/>
        <source>the weave of ArcTech is a part of its weld data, which the pendant makes, and has no number of its own</source>
        <translation>le balayage d&apos;ArcTech fait partie de ses données de soudage, que le pupitre crée, et n&apos;a pas de numéro à lui</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/process.py"/>
        <source>the wire feed of ArcL is set by its welddata</source>
        <translation>le fil de ArcL est dit par ses welddata</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/model/wire.py"/>
        <source>the wire feeds {0} mm3/s, but beads of these classes, at their own travel speeds, take {1} mm3/s: more or less lies there than there is room for; give them a schedule that feeds the wire so, or the travel speed of the others</source>
        <translation>le fil apporte {0} mm3/s, mais les cordons de ces classes, à leurs propres vitesses d&apos;avance, en demandent {1} mm3/s : il y a là plus ou moins de matière que de place ; donnez-leur un programme de soudage qui alimente ainsi le fil, ou la vitesse d&apos;avance des autres</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/model/wire.py"/>
        <source>the wire feeds {0} mm3/s, {1} mm/s of {2} mm wire, but beads of {3} x {4} mm at {5} mm/s take {6} mm3/s; set process.wire.feed to {7} mm/s, or to auto, or make width, layer height and travel speed what they are</source>
        <translation>le fil apporte {0} mm3/s, {1} mm/s d&apos;un fil de {2} mm, mais des cordons de {3} x {4} mm à {5} mm/s en demandent {6} mm3/s ; mettez process.wire.feed à {7} mm/s, ou à auto, ou donnez à la largeur, à la hauteur de couche et à la vitesse d&apos;avance leurs vraies valeurs</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/columns.py"/>
        <source>the wire goes on after its bead</source>
        <translation>le fil continue après son cordon</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/read_process.py"/>
        <source>the wire is fed by two scales at once, or ends where it was not fed, or within a bead</source>
        <translation>le fil est dévidé par deux échelles à la fois, ou s&apos;arrête là où il ne l&apos;était pas, ou au sein d&apos;un cordon</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/inverse/opw_recognition.py"/>
        <source>the wrist centre lies above axis 3, without a forearm along axis 4</source>
        <translation>le centre du poignet est au-dessus de l&apos;axe 3, sans avant-bras le long de l&apos;axe 4</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/inverse/recognition.py"/>
        <source>the wrist is not spherical, and axis 4 passes {0} mm off axis 1</source>
        <translation>le poignet n&apos;est pas sphérique, et l&apos;axe 4 passe à {0} mm à côté de l&apos;axe 1</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/inverse/opw_recognition.py"/>
        <source>the wrist is not spherical: axis 4 is parallel to axes 2 and 3, as of the arms of Universal Robots</source>
        <translation>le poignet n’est pas sphérique : l’axe 4 est parallèle aux axes 2 et 3, comme sur les bras d’Universal Robots</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/inverse/opw_recognition.py"/>
        <source>the wrist is not spherical: axis {0} passes {1} mm off the point where axes 4 and 5 meet</source>
        <translation>le poignet n&apos;est pas sphérique : l&apos;axe {0} passe à {1} mm du point où les axes 4 et 5 se rencontrent</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/inverse/opw_recognition.py"/>
        <source>the wrist is not spherical: axis {0} passes {1} mm off the point where axes 5 and 6 meet</source>
        <translation>le poignet n&apos;est pas sphérique : l&apos;axe {0} passe à {1} mm du point où les axes 5 et 6 se rencontrent</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/staubli/files.py"/>
        <source>there are files that belong to no project, or to two</source>
        <translation>il y a des fichiers qui n&apos;appartiennent à aucun projet, ou à deux</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/read.py"/>
        <source>there are modules that are never run, or run twice</source>
        <translation>il y a des modules qui ne sont jamais exécutés, ou le sont deux fois</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/read.py"/>
        <source>there are no moves</source>
        <translation>il n&apos;y a pas de mouvements</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/point_file.py"/>
        <source>there are no points in it; give rows of x y z</source>
        <translation>il n&apos;y a pas de points dedans ; donnez des lignes de x y z</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/tree.py"/>
        <source>there are too many values; give at most {0}</source>
        <translation>il y a trop de valeurs ; donnez-en au plus {0}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/staubli/read.py"/>
        <source>there are {0} applications, expected one with its parts</source>
        <translation>il y a {0} applications, une seule attendue avec ses parties</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/ur/read.py"/>
        <source>there are {0} files, expected one script</source>
        <translation>il y a {0} fichiers, un seul script est attendu</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/siemens/read.py"/>
        <source>there are {0} main programs, expected one with its parts</source>
        <translation>il y a {0} programmes principaux, un seul attendu avec ses parties</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/linuxcnc/read.py"/>
        <source>there are {0} programs that are not subs, expected one</source>
        <translation>il y a {0} programmes qui ne sont pas des sous-programmes, un seul attendu</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/urdf/cell.py"/>
        <source>there are {0} robots in it, the last axes of which are {1}; name one in `cell.machine`, with base and tip, and what stands beside it in `{2}`</source>
        <translation>il y a {0} robots dedans, dont les derniers axes sont {1} ; nommez-en un dans `cell.machine`, avec base et tip, et ce qui se trouve à côté dans `{2}`</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/check_poses.py"/>
        <source>there are {0}; give at least 3 joint vectors with their flange poses</source>
        <translation>il y en a {0} ; donnez au moins 3 vecteurs articulaires avec leurs poses de bride</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/poses_page.py"/>
        <source>there are {}; at least {} are needed, for a machine without them is not loaded; enter more</source>
        <translation>il y en a {} ; il en faut au moins {}, car une machine sans elles n&apos;est pas chargée ; saisissez-en d&apos;autres</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/tree.py"/>
        <source>there can be no such file ({0}); check the path</source>
        <translation>un tel fichier ne peut pas exister ({0}) ; vérifiez le chemin</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/user_machines.py"/>
        <source>there is a machine {0} already; choose another name</source>
        <translation>il y a déjà une machine {0} ; choisissez un autre nom</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/urdf/read.py"/>
        <source>there is a {0} {1} already, in line {2}; rename one of the two</source>
        <translation>il y a déjà un {0} {1}, à la ligne {2} ; renommez l&apos;un des deux</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/urdf/read.py"/>
        <source>there is no &lt;{0}&gt;; choose the URDF of a robot</source>
        <translation>il n&apos;y a pas de &lt;{0}&gt; ; choisissez l&apos;URDF d&apos;un robot</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/urdf/cell.py"/>
        <source>there is no URDF {0}; check the path</source>
        <translation>il n’y a pas d’URDF {0} ; vérifiez le chemin</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/program/build.py"/>
        <source>there is no bead {0} in a layer {1}; choose from layers 0 to {2}</source>
        <translation>il n&apos;y a pas de cordon {0} dans une couche {1} ; choisissez parmi les couches 0 à {2}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/calibration.py"/>
        <source>there is no calibration {0}; give the path of the YAML file that ur_calibration wrote of this arm</source>
        <translation>il n&apos;y a pas d&apos;étalonnage {0} ; donner le chemin du fichier YAML que ur_calibration a écrit pour ce bras</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/cell.py"/>
        <source>there is no file {0}; check the path, relative to the file with it</source>
        <translation>il n&apos;y a pas de fichier {0} ; vérifiez le chemin, relatif au fichier qui le contient</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/cell.py"/>
        <source>there is no file; write machine: {{file: robot.urdf}}</source>
        <translation>il n&apos;y a pas de fichier ; écrivez machine: {{file: robot.urdf}}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/interop/export.py"/>
        <source>there is no folder {0}; make it, or choose another</source>
        <translation>il n&apos;y a pas de dossier {0} ; créez-le, ou choisissez-en un autre</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/preferences/page.py"/>
        <source>there is no folder {}</source>
        <translation>il n&apos;y a pas de dossier {}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/joint_path.py"/>
        <source>there is no joint path yet; recompute the document</source>
        <translation>il n&apos;y a pas encore de trajectoire articulaire ; recalculez le document</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/machine.py"/>
        <source>there is no joint; add one for each axis</source>
        <translation>il n&apos;y a pas d&apos;articulation ; ajoutez-en une par axe</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/fields.py"/>
        <source>there is no key {0}; did you mean {1}?</source>
        <translation>il n&apos;y a pas de clé {0} ; vouliez-vous dire {1} ?</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/fields.py"/>
        <source>there is no key {0}; use one of {1}</source>
        <translation>il n&apos;y a pas de clé {0} ; utilisez l&apos;une de {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/fit_layers.py"/>
        <source>there is no layer above {0}: the last one of {1} is {2}; give a lower one</source>
        <translation>il n&apos;y a pas de couche au-dessus de {0} : la dernière des {1} est {2} ; donnez-en une plus basse</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/urdf/read.py"/>
        <source>there is no link {0}; name one that is there</source>
        <translation>il n&apos;y a pas de corps {0} ; nommez-en un qui existe</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/machine.py"/>
        <source>there is no machine file {0}; check the path</source>
        <translation>il n&apos;y a pas de fichier machine {0} ; vérifiez le chemin</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/files/three_mf.py"/>
        <source>there is no model in it ({0})</source>
        <translation>il n&apos;y a pas de modèle dedans ({0})</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/filling/fill.py"/>
        <source>there is no pattern {0}; use one of {1}</source>
        <translation>il n&apos;y a pas de motif {0} ; utilisez l&apos;un de {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/results/stored.py"/>
        <source>there is no result yet; recompute it</source>
        <translation>il n&apos;y a pas encore de résultat ; recalculez-le</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/urdf/cell.py"/>
        <source>there is no robot in it: no chain has six turning axes on nothing but axes that slide; the longest is {0}</source>
        <translation>il n&apos;y a pas de robot dedans : aucune chaîne n&apos;a six axes qui tournent portés par des axes qui glissent seulement ; la plus longue est {0}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/denavit_hartenberg.py"/>
        <source>there is no row; give one per joint</source>
        <translation>il n&apos;y a pas de ligne ; donnez-en une par articulation</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/files/read.py"/>
        <source>there is no such file; check the name and the folder</source>
        <translation>il n&apos;y a pas de tel fichier ; vérifiez le nom et le dossier</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/shapes/part_file.py"/>
        <source>there is no such file; check the path</source>
        <translation>il n&apos;y a pas de tel fichier ; vérifiez le chemin</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/fields.py"/>
        <source>there is no value; give {0}</source>
        <translation>il n&apos;y a pas de valeur ; donnez {0}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/model/bead_table.py"/>
        <source>there is no {0}; mend the row, or leave it out</source>
        <translation>il n&apos;y a pas de {0} ; corrigez la ligne, ou retirez-la</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/work/faults.py"/>
        <source>there is not enough memory to compute it; give larger steps, such as layer height and chord error, or a smaller part</source>
        <translation>la mémoire ne suffit pas pour le calculer ; donnez des pas plus grands, comme la hauteur de couche et l&apos;erreur de corde, ou une pièce plus petite</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>there is nothing to be seen in these layers</source>
        <translation>il n&apos;y a rien à voir dans ces couches</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/patch_wall.py"/>
        <source>there is nothing to grow on: none of its edges lies on the platform, the plane Z = {0} mm through its lowest place {1}; choose a substrate, or the edges to start from</source>
        <translation>il n&apos;y a rien sur quoi croître : aucune de ses arêtes n&apos;est sur le plateau, le plan Z = {0} mm par son point le plus bas {1} ; choisissez un substrat, ou les arêtes d&apos;où partir</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/deposit.py"/>
        <source>there is only one layer</source>
        <translation>il n’y a qu’une couche</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/place.py"/>
        <source>these are {0} poses, more than {1}; give a larger step or a smaller box</source>
        <translation>cela fait {0} poses, plus que {1} ; donnez un pas plus grand ou une boîte plus petite</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/clearance/helpful.py"/>
        <source>these points would have room with {0}, which was not tried for the others</source>
        <translation>ces points auraient de la place avec {0}, ce qui n&apos;a pas été essayé pour les autres</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/denavit_hartenberg.py"/>
        <source>theta, d, a and alpha must be numbers; give all four</source>
        <translation>theta, d, a et alpha doivent être des nombres ; donnez les quatre</translation>
    </message>
    <message>
        <location filename="../../freecad_am/interop/step_wires.py"/>
        <source>this FreeCAD has no module Import; write DXF instead</source>
        <translation>ce FreeCAD n&apos;a pas de module Import ; écrivez DXF</translation>
    </message>
    <message>
        <location filename="../../freecad_am/interop/neighbour.py"/>
        <source>this FreeCAD has no {0} workbench; install it or {1} instead</source>
        <translation>ce FreeCAD n&apos;a pas d&apos;atelier {0} ; installez-le, ou {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/tree.py"/>
        <source>this Python cannot read YAML; install PyYAML into it</source>
        <translation>ce Python ne sait pas lire YAML ; installez-y PyYAML</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/point_file.py"/>
        <source>this and most other lines are not points; give rows of x y z</source>
        <translation>celle-ci et la plupart des autres lignes ne sont pas des points ; donnez des lignes de x y z</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/inverse/opw_recognition.py"/>
        <source>this cannot be planned for: {0}; {1}</source>
        <translation>cette machine ne peut pas être planifiée : {0} ; {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/urdf/read.py"/>
        <source>this is &lt;{0}&gt;, not the &lt;robot&gt; of a URDF; choose the URDF of a robot</source>
        <translation>c&apos;est &lt;{0}&gt;, et non le &lt;robot&gt; d&apos;un URDF ; choisissez l&apos;URDF d&apos;un robot</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/tree.py"/>
        <source>this is nested too deeply; give at most {0} levels</source>
        <translation>l&apos;imbrication est trop profonde ; donnez au plus {0} niveaux</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/tree.py"/>
        <source>this is nested too deeply; give keys such as {0}</source>
        <translation>l&apos;imbrication est trop profonde ; donnez des clés comme {0}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/urdf/elements.py"/>
        <source>this is not XML: {0}; export the URDF again</source>
        <translation>ce n&apos;est pas du XML : {0} ; exportez de nouveau l&apos;URDF</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/tree.py"/>
        <source>this is not YAML: {0}; mend that place</source>
        <translation>ce n&apos;est pas du YAML : {0} ; corrigez cet endroit</translation>
    </message>
    <message>
        <location filename="../../freecad_am/api.py"/>
        <source>this is not a cell; choose one</source>
        <translation>ceci n&apos;est pas une cellule ; choisissez-en une</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/file_content.py"/>
        <source>this is not a file but a device, a pipe or a folder; name a file</source>
        <translation>ce n&apos;est pas un fichier mais un périphérique, un tube ou un dossier ; nommez un fichier</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/tree.py"/>
        <source>this is not a mapping; give keys such as {0}</source>
        <translation>ce n&apos;est pas un ensemble de clés ; donnez des clés comme {0}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/urdf/read.py"/>
        <source>this is xacro; make a URDF of it first, with the program xacro of ROS</source>
        <translation>c&apos;est du xacro ; faites-en d&apos;abord un URDF, avec le programme xacro de ROS</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/calibration.py"/>
        <source>this key is missing; give the file as ur_calibration wrote it</source>
        <translation>cette clé manque ; donnez le fichier tel que ur_calibration l&apos;a écrit</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/shape/compare.py"/>
        <source>this layer is predicted to end {0} mm above where the next one should begin: up to here layers come out {1} mm high in the mean, and {2} mm are planned; set strategy.layer_height to {3} mm, or change what the wire feeds</source>
        <translation>d&apos;après la prédiction, cette couche finit {0} mm au-dessus du début prévu de la suivante : jusqu&apos;ici les couches font en moyenne {1} mm de haut, et {2} mm sont prévus ; mettez strategy.layer_height à {3} mm, ou changez ce que le fil apporte</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/shape/compare.py"/>
        <source>this layer is predicted to end {0} mm below where the next one should begin: up to here layers come out {1} mm high in the mean, and {2} mm are planned; set strategy.layer_height to {3} mm, or change what the wire feeds</source>
        <translation>d&apos;après la prédiction, cette couche finit {0} mm au-dessous du début prévu de la suivante : jusqu&apos;ici les couches font en moyenne {1} mm de haut, et {2} mm sont prévus ; mettez strategy.layer_height à {3} mm, ou changez ce que le fil apporte</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>this machine has no condition</source>
        <translation>cette machine n&apos;a pas de condition</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/walls/fronts.py"/>
        <source>this wall has no closed parameter whose lines layers could follow (several faces, openings, a side or a slanted end); use constant-distance or smooth</source>
        <translation>cette paroi n&apos;a pas de paramètre fermé dont les lignes puissent guider des couches (plusieurs faces, ouvertures, un côté ou une extrémité oblique) ; utilisez constant-distance ou smooth</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/mesh/solid.py"/>
        <source>three or more triangles share an edge</source>
        <translation>trois triangles ou plus partagent une arête</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/mesh/repair.py"/>
        <source>three or more triangles share an edge: {0} edges, the first at {1}; repair the mesh (Mesh, Analyze)</source>
        <translation>trois triangles ou plus partagent une arête : {0} arêtes, la première en {1} ; réparez le maillage (Mesh, Analyser)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/choices.py"/>
        <source>through the part, without support</source>
        <translation>à travers la pièce, sans support</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/colouring.py"/>
        <source>tilt</source>
        <translation>inclinaison</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/dock.py"/>
        <source>time</source>
        <translation>temps</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/dock.py"/>
        <source>to</source>
        <translation>à</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/clearance/notes.py"/>
        <source>to keep the nozzle clear, tool axes turn by up to {0} deg/mm, faster than build_direction.max_turn ({1} deg/mm); use a slimmer nozzle or allow a faster turn</source>
        <translation>pour tenir la buse éloignée, les axes de l&apos;outil tournent jusqu&apos;à {0} deg/mm, plus vite que build_direction.max_turn ({1} deg/mm) ; utilisez une buse plus fine ou permettez une rotation plus rapide</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/walls/directions.py"/>
        <source>tool axes are spread along the bead, by up to {0} deg, to turn no faster than build_direction.max_turn</source>
        <translation>les axes de l&apos;outil sont étalés le long du cordon, jusqu&apos;à {0} deg, pour ne pas tourner plus vite que build_direction.max_turn</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/walls/directions.py"/>
        <source>tool axes are turned back by up to {0} deg to stay within build_direction.max_tilt</source>
        <translation>les axes de l&apos;outil sont ramenés jusqu&apos;à {0} deg pour rester dans build_direction.max_tilt</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/curves/gcode.py"/>
        <source>tool lengths are not known; let the slicer leave them out</source>
        <translation>les longueurs d&apos;outil ne sont pas connues ; faites-les omettre par le trancheur</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/choices.py"/>
        <source>tool on robot</source>
        <translation>outil sur robot</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/choices.py"/>
        <source>tool on the robot, part on a positioner</source>
        <translation>outil sur le robot, pièce sur un positionneur</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/ur/read.py"/>
        <source>tool or platform is set again</source>
        <translation>l&apos;outil ou le plateau est redéfini</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>tool-on-robot</source>
        <translation>outil sur le robot</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>tool-on-robot+positioner</source>
        <translation>outil sur le robot + positionneur</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/toolpath.py"/>
        <source>toolpath</source>
        <translation>trajectoire d&apos;outil</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>top</source>
        <translation>haut</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/surface_feature.py"/>
        <source>torus, cone (cylinders too) or table; patches for a wall of any connected faces; mesh.</source>
        <translation>tore, cône (cylindres aussi) ou table ; patches pour une paroi de faces quelconques qui se tiennent ; mesh.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>travel speed</source>
        <translation>vitesse d&apos;avance</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>triangles</source>
        <translation>triangles</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>trim</source>
        <translation>coupée</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/path_view.py"/>
        <source>tubes</source>
        <translation>tubes</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/controls.py"/>
        <source>turn</source>
        <translation>tour</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/field.py"/>
        <source>turn rate</source>
        <translation>rotation par longueur</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/curves/gcode.py"/>
        <source>turned coordinates are not known; let the slicer leave them out</source>
        <translation>les coordonnées tournées ne sont pas connues ; faites-les omettre par le trancheur</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/inspect.py"/>
        <source>turning it about the centre of the sphere</source>
        <translation>une rotation autour du centre de la sphère</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/fanuc/read.py"/>
        <source>two files hold a program of the same name</source>
        <translation>deux fichiers contiennent un programme du même nom</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/inspection.py"/>
        <source>um</source>
        <translation>um</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/colouring.py"/>
        <source>unreachable</source>
        <translation>hors d&apos;atteinte</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/choices.py"/>
        <source>up</source>
        <translation>haut</translation>
    </message>
    <message>
        <location filename="../../freecad_am/plots/deviation.py"/>
        <source>up in the picture</source>
        <translation>vers le haut de l&apos;image</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/staleness.py"/>
        <source>up to date</source>
        <translation>à jour</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/walls/fronts.py"/>
        <source>up to {0} mm of the wall are left above the last whole layer</source>
        <translation>jusqu&apos;à {0} mm de la paroi restent au-dessus de la dernière couche entière</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/source_page.py"/>
        <source>use 0 or 1</source>
        <translation>utilisez 0 ou 1</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/frames_page.py"/>
        <source>use 1 or -1</source>
        <translation>utilisez 1 ou -1</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/revolution/platform.py"/>
        <source>use mount: feature</source>
        <translation>utilisez mount: feature</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/revolution/platform.py"/>
        <source>use mount: feature, or move the part</source>
        <translation>utilisez mount: feature, ou déplacez la pièce</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/revolution/platform.py"/>
        <source>use mount: feature, which puts its lowest end on the platform, move the part up in its file, or set cell.platform_diameter to what there is (0 for none)</source>
        <translation>utilisez mount: feature, qui pose son extrémité la plus basse sur le plateau, remontez la pièce dans son fichier, ou réglez cell.platform_diameter sur ce qui existe (0 pour aucun)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/clearance/helpful.py"/>
        <source>use other layers or another direction, or leave out what these points belong to</source>
        <translation>prenez d&apos;autres couches ou une autre direction, ou laissez de côté ce à quoi ces points appartiennent</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/fit_plot.py"/>
        <source>v in mm/min; R² {:.4f}, RMSE {:.3f} mm</source>
        <translation>v en mm/min ; R² {:.4f}, RMSE {:.3f} mm</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/preferences/page.py"/>
        <source>violet to orange</source>
        <translation>violet à orange</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>volume</source>
        <translation>volume</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/deposit.py"/>
        <source>volume of the beads, as wide as they are apart, less what they cover, against 10 % of the part</source>
        <translation>volume des cordons, aussi larges que leur écartement, moins ce qu&apos;ils couvrent, par rapport à 10 % de la pièce</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/deposit.py"/>
        <source>volume of the beads, as wide as they are laid, outside of their layers, and of layers outside of the part</source>
        <translation>volume des cordons, aussi larges que déposés, hors de leurs couches, et des couches hors de la pièce</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/deposit.py"/>
        <source>volume of the beads, as wide as they count, that is wider than the part is thick</source>
        <translation>volume des cordons, de la largeur qui compte, qui dépasse l’épaisseur de la pièce</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/deposit.py"/>
        <source>volume of the part deeper than half of a bead&apos;s width below the wall, or of its solids aside</source>
        <translation>volume de la pièce plus profond qu’une demi-largeur de cordon sous la paroi, ou de ses solides à côté</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/deposit.py"/>
        <source>volume of the part less what beads cover of each layer, as wide as they count, times the layer height</source>
        <translation>volume de la pièce moins ce que les cordons couvrent de chaque couche, à la largeur comptée, fois la hauteur de couche</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/model/notes.py"/>
        <source>w = {0} v^(-1/3) + {1} / r + {2} with R2 = {3} and RMSE = {4} mm; a width of {5} mm takes travel speeds of {6} to {7} mm/min</source>
        <translation>w = {0} v^(-1/3) + {1} / r + {2} avec R2 = {3} et RMSE = {4} mm ; une largeur de {5} mm demande des vitesses d&apos;avance de {6} à {7} mm/min</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/simulation/wording.py"/>
        <source>waits</source>
        <translation>attend</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/stage.py"/>
        <source>waits for {0}: {1}</source>
        <translation>attend {0} : {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/stage.py"/>
        <source>waits for {0}; recompute</source>
        <translation>attend {0} ; recalculez</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/simulation/wording.py"/>
        <source>waits, deposit on</source>
        <translation>attend, dépôt en marche</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/staleness.py"/>
        <source>warning</source>
        <translation>avertissement</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/colouring.py"/>
        <source>way</source>
        <translation>parcours</translation>
    </message>
    <message>
        <location filename="../../freecad_am/interop/export.py"/>
        <source>waypoints are written as .csv; end the name with it</source>
        <translation>les points sont écrits en .csv ; terminez le nom ainsi</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/process_data.py"/>
        <source>weld data is not taken of the controller yet, has two speeds or another than declared</source>
        <translation>des données de soudage ne sont pas encore reprises de la commande, ont deux vitesses ou une autre que déclarée</translation>
    </message>
    <message>
        <location filename="../../freecad_am/read_back/events.py"/>
        <source>what happens between moves is in another order than planned</source>
        <translation>ce qui se passe entre les mouvements est dans un autre ordre que planifié</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/process_data.py"/>
        <source>what is taken of the controller is not weld data of the module, or taken twice</source>
        <translation>ce qui est repris de la commande n&apos;est pas une donnée de soudage du module, ou l&apos;est deux fois</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/deposit.py"/>
        <source>what of beads of one layer is wider than they are apart, against 10 % of the beads</source>
        <translation>ce que les cordons d&apos;une couche ont de plus large que leur écart, contre 10 % des cordons</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/preferences/page.py"/>
        <source>what the machine&apos;s controller reads</source>
        <translation>ce que lit la commande de la machine</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/kuka/post.py"/>
        <source>what the robot&apos;s own base is on, which no MACHINE_DEF gives</source>
        <translation>ce qui porte la base du robot lui-même, qu&apos;aucun MACHINE_DEF ne dit</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/fields/plain_text.py"/>
        <source>what was deleted</source>
        <translation>ce qui a été supprimé</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/work_offset.py"/>
        <source>what was touched is {0} times as large as what is planned; one of them is in {1}, give both in mm</source>
        <translation>ce qui a été palpé est {0} fois plus grand que ce qui est prévu ; l&apos;un des deux est en {1}, donnez les deux en mm</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/work_offset.py"/>
        <source>what was touched is {0} times as large as what is planned; these are points of another part, or in another order</source>
        <translation>ce qui a été palpé est {0} fois plus grand que ce qui est prévu ; ce sont des points d&apos;une autre pièce, ou dans un autre ordre</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/process.py"/>
        <source>whether TriggSpeed follows the speed over a part that moves was not confirmed</source>
        <translation>que TriggSpeed suive la vitesse sur une pièce mobile n&apos;a pas été confirmé</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/kuka/post.py"/>
        <source>whether WAIT FOR looks at $ANIN until it changes was not found documented</source>
        <translation>que WAIT FOR regarde $ANIN jusqu&apos;à ce qu&apos;il change n&apos;a été trouvé documenté nulle part</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/fanuc/post.py"/>
        <source>whether the speed of linear moves counts the way that a track carries the robot depends on how its rail was set up, and was not confirmed; use `motion: joint`, whose times hold the speed</source>
        <translation>si la vitesse des mouvements linéaires compte le chemin dont un rail porte le robot dépend de la manière dont ce rail a été configuré, et n&apos;a pas été confirmé ; utiliser `motion: joint`, dont les durées tiennent la vitesse</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/strategy.py"/>
        <source>whole</source>
        <translation>entière</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/colouring.py"/>
        <source>width</source>
        <translation>largeur</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/model/bead_table.py"/>
        <source>wire feed {0} m/min is not a positive number; mend the row, or leave it out</source>
        <translation>le dévidage {0} m/min n&apos;est pas un nombre positif ; corrigez la ligne, ou retirez-la</translation>
    </message>
    <message>
        <location filename="../../freecad_am/interop/export.py"/>
        <source>wires are written as .step or .dxf; end the name with one of them</source>
        <translation>les fils sont écrits en .step ou .dxf ; terminez le nom par l&apos;un d&apos;eux</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/siemens/read.py"/>
        <source>with TRAORI a move needs X Y Z A3 B3 C3 F, G94, FGROUP, ORIWKS and a work offset</source>
        <translation>avec TRAORI un mouvement demande X Y Z A3 B3 C3 F, G94, FGROUP, ORIWKS et un décalage d&apos;origine</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/walls/mesh_wall.py"/>
        <source>with edges of {0} mm, a layer height, the mesh of the wall has more than {1} triangles; use a larger layer height, or deposit the wall in parts</source>
        <translation>avec des arêtes de {0} mm, une hauteur de couche, le maillage de la paroi a plus de {1} triangles ; prenez des couches plus hautes, ou déposez la paroi en plusieurs parties</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/sheet.py"/>
        <source>with edges of {0} mm, by layer height and smallest radius, the mesh of the wall has more than {1} triangles, about {2}; use a larger layer height, round sharp bends more, or deposit the wall in parts</source>
        <translation>avec des arêtes de {0} mm, d&apos;après la hauteur de couche et le plus petit rayon, le maillage de la paroi a plus de {1} triangles, environ {2} ; prenez une plus grande hauteur de couche, arrondissez davantage les coudes serrés, ou déposez la paroi par parties</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/read_process.py"/>
        <source>with the arc blocked the move has another speed</source>
        <translation>avec l&apos;arc bloqué le mouvement a une autre vitesse</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/kuka/post.py"/>
        <source>with the part on the robot linear moves of KRL have a fixed tool ($IPO_MODE #TCP), and whether points are then the nozzle seen from the part or the part seen from the nozzle was not confirmed; use `setup: tool-on-robot`</source>
        <translation>avec la pièce sur le robot, les mouvements linéaires de KRL ont un outil fixe ($IPO_MODE #TCP), et que les points soient alors la buse vue de la pièce ou la pièce vue de la buse n&apos;a pas été confirmé ; prenez `setup: tool-on-robot`</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/size.py"/>
        <source>with the tool axes asked for the nozzle touches beads of {0} points; finding tilts that keep it clear takes about {1} min of the processor, several times that where the tool would turn too fast; a smaller build_direction.lead and build_direction.tilt, or clearance: none, saves it</source>
        <translation>avec les axes d&apos;outil demandés, la buse touche des cordons de {0} points ; trouver des inclinaisons qui la dégagent prend environ {1} min de processeur, plusieurs fois plus là où l&apos;outil tournerait trop vite ; un build_direction.lead et un build_direction.tilt plus petits, ou clearance: none, l&apos;évitent</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/names.py"/>
        <source>with the {0} digits of its parts it has more than {1} characters</source>
        <translation>avec les {0} chiffres de ses parties il a plus de {1} caractères</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/size.py"/>
        <source>with tilts that keep the nozzle clear the tool turns faster than build_direction.max_turn on beads of {0} points; finding slower ones takes up to {1} min of the processor; a larger build_direction.max_turn, a slimmer nozzle, or clearance: none, saves it</source>
        <translation>avec des inclinaisons qui dégagent la buse, l&apos;outil tourne plus vite que build_direction.max_turn sur des cordons de {0} points ; en chercher de plus lentes prend jusqu&apos;à {1} min de processeur ; un build_direction.max_turn plus grand, une buse plus fine, ou clearance: none, l&apos;évitent</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/clearance/helpful.py"/>
        <source>with {0} the nozzle is clear, which was tried</source>
        <translation>avec {0} la buse est dégagée, ce qui a été essayé</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/upright.py"/>
        <source>with {0} the nozzle is clear; the toolpath was planned so, joints were not</source>
        <translation>avec {0} la buse est dégagée ; la trajectoire d&apos;outil a été planifiée ainsi, les articulations non</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/remedies.py"/>
        <source>with {0} the {1} of the layers in question that were planned again are feasible; the whole job was not tried</source>
        <translation>avec {0}, les {1} couches en cause replanifiées sont faisables ; le travail entier n’a pas été essayé</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/remedies.py"/>
        <source>with {0} this job is feasible; tried, not applied</source>
        <translation>avec {0}, ce travail est faisable ; essayé, non appliqué</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/program/beads.py"/>
        <source>within a bead only an output can change the schedule: calls stop the machine, and that arc instructions do not was not confirmed; use output, or leave the schedules of start and end out</source>
        <translation>un autre programme de soudage à l&apos;intérieur d&apos;un cordon n&apos;est transmis que par une sortie : les appels arrêtent la machine, et que les instructions d&apos;arc ne le fassent pas n&apos;a pas été confirmé ; prenez output, ou omettez les programmes de start et end</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/patch_wall.py"/>
        <source>within {0} mm</source>
        <translation>à {0} mm près</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/toolpaths.py"/>
        <source>without a bead model or a ramp the travel speed does not vary, and the wire has nothing to follow; use constant, a process.bead_model, or process.start.ramp or process.end.ramp</source>
        <translation>sans modèle de cordon ni rampe, la vitesse d&apos;avance ne varie pas et le fil n&apos;a rien à suivre ; utilisez constant, un process.bead_model, ou process.start.ramp ou process.end.ramp</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/linuxcnc/post.py"/>
        <source>work offset {0} is not there for the part; use 1 to {1} (G54 to G59.2; the ninth, {2}, is set to zero for moves of the axes)</source>
        <translation>le décalage d&apos;origine {0} n&apos;existe pas pour la pièce ; utilisez 1 à {1} (G54 à G59.2 ; le neuvième, {2}, est mis à zéro pour les mouvements des axes)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/interop/cam_path.py"/>
        <source>write STEP or DXF</source>
        <translation>écrivez STEP ou DXF</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/quantity.py"/>
        <source>write decimals with &apos;{0}&apos;, as in 1{1}5 {2}, and do not group digits</source>
        <translation>écrivez les décimales avec &apos;{0}&apos;, comme 1{1}5 {2}, et ne groupez pas les chiffres</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/touched.py"/>
        <source>write such as: 0 0 0 = 900.4 2.1 -99.7; 100 0 0 = 1000.3 1.2 -99.9; 0 80 0 = 901 82 -99.5</source>
        <translation>écrivez par exemple : 0 0 0 = 900.4 2.1 -99.7 ; 100 0 0 = 1000.3 1.2 -99.9 ; 0 80 0 = 901 82 -99.5</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/bead_classes.py"/>
        <source>write such as: contour: travel_speed 8, schedule 3; fill: lead 5</source>
        <translation>écrivez par exemple `contour: travel_speed 8, schedule 3; fill: lead 5`</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/external.py"/>
        <source>write such as: motoman-motopos-d500 at 1500 0 0 0 0 0 carries part</source>
        <translation>écrivez par exemple : motoman-motopos-d500 at 1500 0 0 0 0 0 carries part</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/obstacles.py"/>
        <source>write such as: table = table.step at 0 0 -200 0 0 0; post = box 60 60 400 at 900 200 0 0 0 0</source>
        <translation>écrivez par exemple : table = table.step at 0 0 -200 0 0 0 ; post = box 60 60 400 at 900 200 0 0 0 0</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/facts.py"/>
        <source>zigzag</source>
        <translation>zigzag</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/layers/curved/field.py"/>
        <source>{0} % of it hang together with nothing that stands on the platform or the substrate; deposit these by themselves, or set strategy.direction</source>
        <translation>{0} % de la pièce ne tiennent à rien de ce qui repose sur le plateau ou le substrat ; déposez-les à part, ou donnez strategy.direction</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/kuka/read.py"/>
        <source>{0} % of the joint speeds is none of 1 to 100</source>
        <translation>{0} % des vitesses articulaires n&apos;est pas de 1 à 100</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/model/notes.py"/>
        <source>{0} % of the length bends more than the table&apos;s beads, of {1} mm or more, and counts as bent like these; widths are only estimated there</source>
        <translation>{0} % de la longueur est plus courbée que les cordons du tableau, de {1} mm ou plus, et compte comme courbée pareillement ; les largeurs n&apos;y sont qu&apos;estimées</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/tree.py"/>
        <source>{0} (line {1})</source>
        <translation>{0} (ligne {1})</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/tree.py"/>
        <source>{0} (line {1}, column {2})</source>
        <translation>{0} (ligne {1}, colonne {2})</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/issues.py"/>
        <source>{0} (more layers like it: {1})</source>
        <translation>{0} (autres couches de ce genre : {1})</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/check_poses.py"/>
        <source>{0} a flange {1} mm and {2} (largest entry of the rotation) from it; correct the geometry or the pose</source>
        <translation>{0} une bride à {1} mm et {2} (plus grand terme de la rotation) de celle-ci ; corrigez la géométrie ou la pose</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/revolution/wall.py"/>
        <source>{0} all have a wall; name the faces of the one to deposit</source>
        <translation>{0} ont toutes une paroi ; nommez les faces de celle à déposer</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/other_cells.py"/>
        <source>{0} and `cell.branch: auto`</source>
        <translation>{0} et `cell.branch: auto`</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/other_cells.py"/>
        <source>{0} and `cell.branch: {1}`</source>
        <translation>{0} et `cell.branch: {1}`</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/revolution/wall.py"/>
        <source>{0} and {1}</source>
        <translation>{0} et {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/clad_faces.py"/>
        <source>{0} and {1} are faces of different solids; cover each solid as a feature of its own, or fuse them first</source>
        <translation>{0} et {1} sont des faces de solides différents ; recouvrez chaque solide comme un élément à part, ou fusionnez-les d&apos;abord</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/external.py"/>
        <source>{0} and {1} are two mechanisms of one name, {2}; give one of the files another id</source>
        <translation>{0} et {1} sont deux mécanismes d&apos;un même nom, {2} ; donnez un autre id à l&apos;un des fichiers</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/checks.py"/>
        <source>{0} and {1} are {2} mm apart at {3}; close the gap: edges must meet within {4} mm</source>
        <translation>{0} et {1} sont à {2} mm l&apos;une de l&apos;autre en {3} ; fermez le jour : les arêtes doivent se rencontrer à {4} mm près</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/clad_faces.py"/>
        <source>{0} and {1} meet at an angle of {2} deg at {3}: layers above the first grow apart, with a wedge left open between them, up to {4} mm above the faces; round the edge, or cover the faces one after the other</source>
        <translation>{0} et {1} se rejoignent avec un angle de {2} deg en {3} : les couches au-dessus de la première s&apos;écartent, en laissant un coin ouvert entre elles, jusqu&apos;à {4} mm au-dessus des faces ; arrondissez l&apos;arête, ou recouvrez les faces l&apos;une après l&apos;autre</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/clad_faces.py"/>
        <source>{0} and {1} meet at an angle of {2} deg at {3}: layers above the first grow into one another, up to {4} mm above the faces; round the edge, or cover the faces one after the other</source>
        <translation>{0} et {1} se rejoignent avec un angle de {2} deg en {3} : les couches au-dessus de la première entrent l&apos;une dans l&apos;autre, jusqu&apos;à {4} mm au-dessus des faces ; arrondissez l&apos;arête, ou recouvrez les faces l&apos;une après l&apos;autre</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/checks.py"/>
        <source>{0} and {1} meet at an angle of {2} deg at {3}; a wall&apos;s faces must run on smoothly, within {4} deg: round the edge, or deposit the faces one after the other</source>
        <translation>{0} et {1} se rencontrent sous un angle de {2} deg en {3} ; les faces d&apos;une paroi doivent se prolonger sans cassure, à {4} deg près : arrondissez l&apos;arête, ou déposez les faces l&apos;une après l&apos;autre</translation>
    </message>
    <message>
        <location filename="../../freecad_am/macro/steps.py"/>
        <source>{0} are names without an object that they are of; give it too</source>
        <translation>{0} sont des noms sans l’objet auquel ils appartiennent ; donnez-le aussi</translation>
    </message>
    <message>
        <location filename="../../freecad_am/macro/arguments.py"/>
        <source>{0} are not names of faces or edges; give a list of texts, such as [&quot;Face1&quot;]</source>
        <translation>{0} ne sont pas des noms de faces ou d’arêtes ; donnez une liste de textes, telle que [&quot;Face1&quot;]</translation>
    </message>
    <message>
        <location filename="../../freecad_am/macro/arguments.py"/>
        <source>{0} are not values by key; give a mapping</source>
        <translation>{0} ne sont pas des valeurs par clé ; donnez un dictionnaire</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/obstacles.py"/>
        <source>{0} are not {1} numbers; {2}</source>
        <translation>{0} ne sont pas {1} nombres ; {2}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/external/rule.py"/>
        <source>{0} are polynomials per bead, the method {1} has none; use method: {2}, or external_axes: {3}</source>
        <translation>{0} : ce sont des polynômes par cordon, la méthode {1} n&apos;en a pas ; utiliser method : {2}, ou external_axes : {3}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/external.py"/>
        <source>{0} axes carry the part; give one or two turning axes</source>
        <translation>{0} axes portent la pièce ; donnez un ou deux axes tournants</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/solids/filling.py"/>
        <source>{0} bead(s) alone in regions narrower than a bead of {1} mm stand out of them, by up to {2} mm at {3}</source>
        <translation>{0} cordon(s) seuls dans des régions plus étroites qu&apos;un cordon de {1} mm en dépassent, jusqu&apos;à {2} mm en {3}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/walls/beads.py"/>
        <source>{0} bead(s) at the end shorter than half a layer height are left out</source>
        <translation>{0} cordon(s) à la fin plus courts qu&apos;une demi-hauteur de couche sont laissés de côté</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/walls/fronts.py"/>
        <source>{0} bead(s) close gaps between fronts that meet, nearer to them than a layer height; the first in layer {1}</source>
        <translation>{0} cordon(s) comblent les jours entre des fronts qui se rencontrent, à moins d&apos;une hauteur de couche d&apos;eux ; le premier dans la couche {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/revolution/plan.py"/>
        <source>{0} bead(s) of a radius of no more than the chord error ({1} mm) are left out</source>
        <translation>{0} cordon(s) d&apos;un rayon ne dépassant pas l&apos;erreur de corde ({1} mm) sont laissés de côté</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/beads/speeds.py"/>
        <source>{0} bead(s) where the wall closes are run at down to {1} mm/s: the axes turn no faster</source>
        <translation>{0} cordon(s) là où la paroi se ferme sont parcourus jusqu&apos;à {1} mm/s seulement : les axes ne tournent pas plus vite</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/turns/unwrap.py"/>
        <source>{0} beads were split because an axis has not the stroke for a whole bead</source>
        <translation>{0} cordons ont été divisés parce qu&apos;un axe n&apos;a pas la course d&apos;un cordon entier</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/ur/read.py"/>
        <source>{0} calls itself</source>
        <translation>{0} s&apos;appelle lui-même</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/stage.py"/>
        <source>{0} cannot be carried out: {1}</source>
        <translation>{0} ne peut pas être exécuté : {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/external.py"/>
        <source>{0} cannot be carried; use {1} or {2}</source>
        <translation>{0} ne peut pas être porté ; utilisez {1} ou {2}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/arrangement.py"/>
        <source>{0} cannot be planned yet; use {1} or {2}</source>
        <translation>{0} ne peut pas encore être planifié ; utilisez {1} ou {2}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/inspection.py"/>
        <source>{0} cannot be read ({1}); choose the file again</source>
        <translation>{0} ne peut pas être lu ({1}) ; choisissez le fichier de nouveau</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/draft.py"/>
        <source>{0} cannot be the name of a machine; use a to z, digits and -</source>
        <translation>{0} ne peut pas être le nom d&apos;une machine ; utilisez a à z, chiffres et -</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/sheet.py"/>
        <source>{0} cannot be turned to one side (a twisted band has no outside); divide the band, or leave one of its faces out</source>
        <translation>{0} ne peuvent pas être tournées d&apos;un même côté (une bande vrillée n&apos;a pas d&apos;extérieur) ; divisez la bande, ou laissez une de ses faces de côté</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/names.py"/>
        <source>{0} cannot be {1} on the controller: {2}; use {3}</source>
        <translation>{0} ne peut pas être {1} sur la commande : {2} ; utilisez {3}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/nc/parts.py"/>
        <source>{0} cannot switch both on and off; give two different words</source>
        <translation>{0} ne peut pas à la fois mettre en marche et arrêter ; donnez deux mots différents</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/external.py"/>
        <source>{0} carries the robot and is not a track, which is one axis that slides; choose a track</source>
        <translation>{0} porte le robot et n&apos;est pas un rail, c&apos;est-à-dire un axe qui coulisse ; choisissez un rail</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/urdf/cell.py"/>
        <source>{0} chains move beside the robot ({1}), and one can carry the part; name it in `{2}`, with base and tip</source>
        <translation>{0} chaînes bougent à côté du robot ({1}), et une seule peut porter la pièce ; nommez-la dans `{2}`, avec base et tip</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/staleness.py"/>
        <source>{0} changed; recompute</source>
        <translation>{0} a changé ; recalculez</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/inspect.py"/>
        <source>{0} changes no deviation: the points do not determine it</source>
        <translation>{0} ne change aucun écart : les points ne le disent pas</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/in_sequence.py"/>
        <source>{0} cm3 of it are within {1} and would be deposited twice; cut one from the other</source>
        <translation>{0} cm3 de lui se trouvent dans {1} et seraient déposés deux fois ; découpez l&apos;un de l&apos;autre</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/scan.py"/>
        <source>{0} compares with {1}; choose an inspection of the part that is deposited on</source>
        <translation>{0} compare avec {1} ; choisissez un contrôle de la pièce sur laquelle on dépose</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/siemens/read.py"/>
        <source>{0} do not belong together</source>
        <translation>{0} ne vont pas ensemble</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/revolution/wall.py"/>
        <source>{0} do not join to one wall; name the faces of the wall, or deposit them one by one</source>
        <translation>{0} ne se joignent pas en une paroi ; nommez les faces de la paroi, ou déposez-les une à une</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/staubli/read.py"/>
        <source>{0} does not wait for the moves before it</source>
        <translation>{0} n&apos;attend pas les mouvements qui le précèdent</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/slicing/solids/equidistant.py"/>
        <source>{0} edges have not two faces, one at ({1}, {2}, {3}) mm from the hub&apos;s base; close the mesh</source>
        <translation>{0} arêtes n&apos;ont pas deux faces, l&apos;une à ({1}, {2}, {3}) mm de la base du moyeu ; fermez le maillage</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/mesh/repair.py"/>
        <source>{0} edges of more than two triangles were divided, as at {1}</source>
        <translation>{0} arêtes de plus de deux triangles ont été dédoublées, par exemple en {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/deposit/balance.py"/>
        <source>{0} face(s) ({1}) of {2} are not deposited</source>
        <translation>{0} face(s) ({1}) de {2} ne sont pas déposées</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/deposit/balance.py"/>
        <source>{0} face(s) ({1}), about {2} cm3 of the {3} cm3 of {4}, are not deposited</source>
        <translation>{0} face(s) ({1}), environ {2} cm3 des {3} cm3 de {4}, ne sont pas déposées</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>{0} fills the whole, not {1} %; use 100 %, or fill: contours, lines, zigzag, grid, triangles, honeycomb or gyroid</source>
        <translation>{0} remplit tout, non pas {1} % ; choisissez 100 %, ou fill : contours, lines, zigzag, grid, triangles, honeycomb ou gyroid</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/fields/expressions.py"/>
        <source>{0} follows the expression {1}, which gives nothing any more; give {2} a value or another one</source>
        <translation>{0} suit l&apos;expression {1}, qui ne donne plus rien ; donnez à {2} une valeur ou une autre expression</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/urdf/machine.py"/>
        <source>{0} from {1} to {2}: {3}</source>
        <translation>{0} de {1} à {2} : {3}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/urdf/machine.py"/>
        <source>{0} from {1} to {2}: {3}; the robot begins at the link {4}; or write `external: {5}`, which takes track and positioner of the file</source>
        <translation>{0} de {1} à {2} : {3} ; le robot commence au corps {4} ; ou écrivez `external: {5}`, qui prend rail et positionneur du fichier</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/walls/front_tree.py"/>
        <source>{0} fronts merge at layer {1}</source>
        <translation>{0} fronts se rejoignent à la couche {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/walls/front_tree.py"/>
        <source>{0} fronts merge, in {1} places, at layer {2}</source>
        <translation>{0} fronts se rejoignent, en {1} endroits, à la couche {2}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/walls/front_tree.py"/>
        <source>{0} fronts split in {1} each at layer {2}</source>
        <translation>{0} fronts se divisent chacun en {1} à la couche {2}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/fields/expressions.py"/>
        <source>{0} gives {1}, which is not a number; write one that gives a number</source>
        <translation>{0} donne {1}, qui n&apos;est pas un nombre ; écrivez-en une qui donne un nombre</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/entries.py"/>
        <source>{0} has a 0; give the pulses of a degree of each axis, negative where they count down</source>
        <translation>{0} contient un 0 ; donnez les impulsions d&apos;un degré de chaque axe, négatives là où elles décroissent</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/fields/rows.py"/>
        <source>{0} has a comma; write decimals with a point, such as {1}</source>
        <translation>{0} a une virgule ; écrivez les décimales avec un point, comme {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/external.py"/>
        <source>{0} has an axis that slides and carries the part, which cannot be planned yet; use turning axes</source>
        <translation>{0} a un axe linéaire et porte la pièce, ce qui ne peut pas encore être planifié ; utilisez des axes rotatifs</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/fields/rows.py"/>
        <source>{0} has another dimension; give {1}</source>
        <translation>{0} a une autre dimension ; donnez {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/proposed_family.py"/>
        <source>{0} has edges and no faces, which are laid as beads</source>
        <translation>{0} a des arêtes et pas de faces ; elles sont déposées comme cordons</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/curves/gcode.py"/>
        <source>{0} has neither I and J nor R; give the middle of the arc or its radius</source>
        <translation>{0} n&apos;a ni I et J ni R ; donnez le centre de l&apos;arc ou son rayon</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/checks/predicted_shape.py"/>
        <source>{0} has no faces that a deposit could be held against; choose another object</source>
        <translation>{0} n&apos;a pas de faces auxquelles comparer un dépôt ; choisissez un autre objet</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/machine.py"/>
        <source>{0} has no limits {1}; use {2}</source>
        <translation>{0} n&apos;a pas de limites {1} ; utilisez {2}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/urdf/machine.py"/>
        <source>{0} has no link {1}; name one of {2}</source>
        <translation>{0} n&apos;a pas de corps {1} ; nommez-en un de {2}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/staubli/read.py"/>
        <source>{0} has no number</source>
        <translation>{0} n&apos;a pas de numéro</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/checks/controllers.py"/>
        <source>{0} has no spherical wrist, and what its controller calls the configurations of cartesian positions is not known; use joint</source>
        <translation>{0} n&apos;a pas de poignet sphérique, et le nom que sa commande donne aux configurations des positions cartésiennes n&apos;est pas connu ; utilisez joint</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/bead_classes.py"/>
        <source>{0} has no {1}; use one of {2}</source>
        <translation>{0} n&apos;a pas de {1} ; utilisez l&apos;un de {2}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/views/joint_path.py"/>
        <source>{0} has other axes than the joint path; recompute the joint path</source>
        <translation>{0} a d&apos;autres axes que la trajectoire articulaire ; recalculez la trajectoire articulaire</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/cell.py"/>
        <source>{0} has sliding axes; use {1}, or choose another machine</source>
        <translation>{0} a des axes de translation ; utilisez {1}, ou choisissez une autre machine</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/shapes/part_file.py"/>
        <source>{0} has what is in a group of it twice, so that numbers of its faces are not certain; name an object in it, or take that out of the group</source>
        <translation>{0} a deux fois ce qui est dans un de ses groupes, si bien que les numéros de ses faces ne sont pas sûrs ; nommez un objet qu’il contient, ou sortez-le du groupe</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/external.py"/>
        <source>{0} has {1} numbers, a pose has six; {2}</source>
        <translation>{0} a {1} nombres, une pose en a six ; {2}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/parts.py"/>
        <source>{0} has {1} points with its approach, and loading another part within a bead would stop the robot while it deposits; use at least {2}</source>
        <translation>{0} a {1} points avec son approche, et charger une autre partie au sein d&apos;un cordon arrêterait le robot pendant qu&apos;il dépose ; utilisez au moins {2}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/proposed_family.py"/>
        <source>{0} holds {1} solids{2}</source>
        <translation>{0} contient {1} solides{2}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/mesh/repair.py"/>
        <source>{0} holes were closed, the largest {1} mm across at {2}</source>
        <translation>{0} trous ont été bouchés, le plus grand large de {1} mm en {2}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/siemens/read.py"/>
        <source>{0} in a loop that waits for an input</source>
        <translation>{0} dans une boucle qui attend une entrée</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/shapes/document_file.py"/>
        <source>{0} in it does not begin as XML; save it again</source>
        <translation>{0} n&apos;y commence pas comme du XML ; enregistrez-le de nouveau</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/shapes/document_file.py"/>
        <source>{0} in it has a document type, which no document of FreeCAD has, and is not read; save it again</source>
        <translation>{0} y a un type de document, qu&apos;aucun document de FreeCAD n&apos;a, et n&apos;est pas lu ; enregistrez-le de nouveau</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/linuxcnc/read.py"/>
        <source>{0} in or about a loop that waits for an analogue input</source>
        <translation>{0} dans une boucle qui attend une entrée analogique, ou près d&apos;elle</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/checks/controllers.py"/>
        <source>{0} is a URDF, which does not say what the controller shows; plan without a program, or make a machine file of it with New Machine…</source>
        <translation>{0} est un URDF, qui ne dit pas ce que la commande affiche ; planifiez sans programme, ou faites-en un fichier de machine par Nouvelle machine…</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/fields.py"/>
        <source>{0} is a list; give one value</source>
        <translation>{0} est une liste ; donnez une seule valeur</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/solid_feature.py"/>
        <source>{0} is a mesh, which has no edges or faces; choose a shape</source>
        <translation>{0} est un maillage, qui n&apos;a ni arêtes ni faces ; choisissez une forme</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/proposed_family.py"/>
        <source>{0} is a mesh, which is filled</source>
        <translation>{0} est un maillage, qui est rempli</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/read.py"/>
        <source>{0} is a module or a routine of this program and is not loaded</source>
        <translation>{0} est un module ou une routine de ce programme et n&apos;est pas chargé</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/quantity.py"/>
        <source>{0} is a percentage; give {1}</source>
        <translation>{0} est un pourcentage ; donnez {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/refusals.py"/>
        <source>{0} is a program of this very job; call another one, or rename the job</source>
        <translation>{0} est un programme de ce travail même ; appelez-en un autre, ou renommez le travail</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/cell.py"/>
        <source>{0} is a robot; use {1}, or choose another machine</source>
        <translation>{0} est un robot ; utilisez {1}, ou choisissez une autre machine</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/proposed_family.py"/>
        <source>{0} is a skin that turns about one axis</source>
        <translation>{0} est une peau qui tourne autour d&apos;un axe</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/proposed_family.py"/>
        <source>{0} is a solid</source>
        <translation>{0} est un solide</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/proposed_family.py"/>
        <source>{0} is a solid; it turns about one axis, but a wall of one bead would leave out {1} of its {2} cm3</source>
        <translation>{0} est un solide ; il tourne autour d&apos;un axe, mais une paroi d&apos;un cordon laisserait de côté {1} de ses {2} cm3</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/revolution/wall.py"/>
        <source>{0} is a surface: it has no {1} wall, and is taken as it is</source>
        <translation>{0} est une surface : elle n&apos;a pas de paroi {1}, et est prise telle quelle</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/proposed_family.py"/>
        <source>{0} is a thin shell, one bead of {1} mm, on {2}</source>
        <translation>{0} est une coque mince, un cordon de {1} mm, sur {2}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/proposed_family.py"/>
        <source>{0} is a thin wall that grows on {1}</source>
        <translation>{0} est une paroi mince qui croît sur {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/refusals.py"/>
        <source>{0} is also the name of data or a signal that the program uses; call it otherwise</source>
        <translation>{0} est aussi le nom de données ou d&apos;un signal dont le programme se sert ; donnez un autre nom</translation>
    </message>
    <message>
        <location filename="../../freecad_am/macro/arguments.py"/>
        <source>{0} is an object of another document, {1}; give one of {2}, such as a copy of it</source>
        <translation>{0} est un objet d’un autre document, {1} ; donnez-en un de {2}, par exemple une copie</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/proposed_family.py"/>
        <source>{0} is an open mesh that cuts itself at {1} pairs of its triangles, as at {2}, so it is not a wall of one bead: it is filled, with its {3} holes of up to {4} mm closed</source>
        <translation>{0} est un maillage ouvert qui se coupe lui-même en {1} paires de ses triangles, par exemple en {2}, ce n&apos;est donc pas une paroi d&apos;un cordon : il est rempli, ses {3} trous jusqu&apos;à {4} mm étant fermés</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/proposed_family.py"/>
        <source>{0} is an open mesh that lies rather than stands, {1} of it at less than 45 deg to the platform, so it is a face that is covered</source>
        <translation>{0} est un maillage ouvert qui est couché plutôt que debout, dont {1} à moins de 45 deg du plateau, c&apos;est donc une face qui est recouverte</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/proposed_family.py"/>
        <source>{0} is an open mesh, so it is a thin wall that grows on {1}</source>
        <translation>{0} est un maillage ouvert, donc une paroi mince qui croît sur {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/proposed_family.py"/>
        <source>{0} is an open mesh, so it is a thin wall that starts on the platform</source>
        <translation>{0} est un maillage ouvert, donc une paroi mince qui part du plateau</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/proposed_family.py"/>
        <source>{0} is an open skin and not of revolution, and nothing else serves it; it needs a substrate, or edges to start from, and what does not grow from there is left out</source>
        <translation>{0} est une peau ouverte et non de révolution, et rien d&apos;autre ne lui convient ; il lui faut un substrat, ou des arêtes d&apos;où partir, et ce qui n&apos;en croît pas est laissé de côté</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/proposed_family.py"/>
        <source>{0} is an open skin and not of revolution, so it is a thin wall, which starts on the platform where nothing carries it</source>
        <translation>{0} est une peau ouverte qui n&apos;est pas de révolution, donc une paroi mince, qui part du plateau là où rien ne la porte</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/proposed_family.py"/>
        <source>{0} is an open skin that lies rather than stands, {1} of it at less than 45 deg to the platform, so it is a face that is covered</source>
        <translation>{0} est une peau ouverte qui est couchée plutôt que debout, dont {1} à moins de 45 deg du plateau, c&apos;est donc une face qui est recouverte</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/ur/read.py"/>
        <source>{0} is called before it is defined</source>
        <translation>{0} est appelé avant d&apos;être défini</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/staubli/read.py"/>
        <source>{0} is called before it is loaded</source>
        <translation>{0} est appelé avant d&apos;être chargé</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/urdf/cell.py"/>
        <source>{0} is carried by {1}, as the robot is; let the positioner stand on the floor</source>
        <translation>{0} est porté par {1}, comme le robot ; posez le positionneur au sol</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/ur/read.py"/>
        <source>{0} is defined again, or within a part</source>
        <translation>{0} est défini à nouveau, ou dans une partie</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/urdf/cell.py"/>
        <source>{0} is for a machine that is the URDF of the whole cell, such as machine: bay.urdf; or give a list of mechanisms</source>
        <translation>{0} est pour une machine qui est l&apos;URDF de toute la cellule, comme machine: bay.urdf ; ou donnez une liste de mécanismes</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/inspect.py"/>
        <source>{0} is known to {1} mm, by triangles</source>
        <translation>{0} est connu à {1} mm près, par des triangles</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/staubli/read.py"/>
        <source>{0} is loaded while depositing, is not there, or {1} is not a library</source>
        <translation>{0} est chargé pendant le dépôt, n&apos;existe pas, ou {1} n&apos;est pas une bibliothèque</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/read.py"/>
        <source>{0} is loaded without being run and removed</source>
        <translation>{0} est chargé sans être exécuté puis retiré</translation>
    </message>
    <message>
        <location filename="../../freecad_am/macro/links.py"/>
        <source>{0} is made from {1} itself; choose another object</source>
        <translation>{0} est lui-même fait à partir de {1} ; choisissez un autre objet</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/files/three_mf.py"/>
        <source>{0} is missing in it</source>
        <translation>il y manque {0}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/picking/inputs.py"/>
        <source>{0} is missing in this document. Make it first: button {0} in the toolbar.</source>
        <translation>{0} manque dans ce document. Faites-le d&apos;abord : bouton {0} de la barre d&apos;outils.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/stage.py"/>
        <source>{0} is missing; choose {1}</source>
        <translation>{0} manque ; choisissez {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/check_poses.py"/>
        <source>{0} is more than the rounding of a display leaves; give 0 to {1}</source>
        <translation>{0} est plus que ce que laisse l&apos;arrondi d&apos;un affichage ; donnez de 0 à {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/obstacles.py"/>
        <source>{0} is neither a file nor a box, or both; give one of them</source>
        <translation>{0} n&apos;est ni un fichier ni une boîte, ou les deux ; donnez l&apos;un d&apos;eux</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>{0} is neither a length nor six numbers; give one such as 300, or x y z RX RY RZ</source>
        <translation>{0} n&apos;est ni une longueur ni six nombres ; donnez-en une comme 300, ou x y z RX RY RZ</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/fields.py"/>
        <source>{0} is neither true nor false; give one of them</source>
        <translation>{0} n&apos;est ni true ni false ; donnez l&apos;un des deux</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/checks/placed.py"/>
        <source>{0} is none of the parameters that it takes; give {1}</source>
        <translation>{0} n’est pas un des jeux de paramètres attendus ; donnez {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/feature_kinds.py"/>
        <source>{0} is none of {1}; use one of these</source>
        <translation>{0} n&apos;est aucun de {1} ; utilisez l&apos;un d&apos;eux</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/calibration.py"/>
        <source>{0} is not `key: value`; give the file as ur_calibration wrote it</source>
        <translation>{0} n&apos;est pas de la forme `clé: valeur` ; donnez le fichier tel que ur_calibration l&apos;a écrit</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/cell.py"/>
        <source>{0} is not a URDF, and only a URDF has links; write machine: {{file: robot.urdf, base: base_link, tip: tool0}}, or the path of a machine file without braces</source>
        <translation>{0} n&apos;est pas un URDF, qui seul a des segments ; écrivez machine: {{file: robot.urdf, base: base_link, tip: tool0}}, ou le chemin d&apos;un fichier machine sans accolades</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/walls/directions.py"/>
        <source>{0} is not a bend of a torus, so its plane of symmetry is not known; give its normal as build_direction.plane, or use local, layer or fixed</source>
        <translation>{0} n&apos;est pas le coude d&apos;un tore, son plan de symétrie n&apos;est donc pas connu ; donnez sa normale comme build_direction.plane, ou utilisez local, layer ou fixed</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/cell.py"/>
        <source>{0} is not a box; give its edges along x, y and z such as [1200, 800, 30]</source>
        <translation>{0} n&apos;est pas un pavé ; donnez ses arêtes selon x, y et z comme [1200, 800, 30]</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/cell.py"/>
        <source>{0} is not a branch; use [front|back, up|down, flip|noflip] or auto</source>
        <translation>{0} n&apos;est pas une branche ; utilisez [front|back, up|down, flip|noflip] ou auto</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/bead_classes.py"/>
        <source>{0} is not a class of beads; {1}</source>
        <translation>{0} n&apos;est pas une classe de cordons ; {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/links/shape.py"/>
        <source>{0} is not a colour; give red, green and blue from 0 to 1</source>
        <translation>{0} n&apos;est pas une couleur ; donnez rouge, vert et bleu de 0 à 1</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/staubli/read.py"/>
        <source>{0} is not a digital input of the project</source>
        <translation>{0} n&apos;est pas une entrée logique du projet</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/staubli/read.py"/>
        <source>{0} is not a digital output of the project</source>
        <translation>{0} n&apos;est pas une sortie logique du projet</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/build_direction.py"/>
        <source>{0} is not a direction; give three numbers such as 0 1 0, or auto</source>
        <translation>{0} n&apos;est pas une direction ; donnez trois nombres comme 0 1 0, ou auto</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/field.py"/>
        <source>{0} is not a direction; {1}</source>
        <translation>{0} n&apos;est pas une direction ; {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/macro/arguments.py"/>
        <source>{0} is not a document; give one, such as FreeCAD.ActiveDocument</source>
        <translation>{0} n’est pas un document ; donnez-en un, tel que FreeCAD.ActiveDocument</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/developable_feature.py"/>
        <source>{0} is not a face of {1}; choose faces of the hub</source>
        <translation>{0} n&apos;est pas une face de {1} ; choisissez des faces du moyeu</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/shapes/chosen.py"/>
        <source>{0} is not a face; choose faces or the whole shape</source>
        <translation>{0} n&apos;est pas une face ; choisissez des faces ou toute la forme</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/revolution/spiral.py"/>
        <source>{0} is not a full turn; use path: layers</source>
        <translation>{0} n&apos;est pas un tour entier ; utilisez path: layers</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/work/progress.py"/>
        <source>{0} is not a function; give one</source>
        <translation>{0} n’est pas une fonction ; donnez-en une</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/inspection.py"/>
        <source>{0} is not a height; give numbers in mm</source>
        <translation>{0} n&apos;est pas une hauteur ; donnez des nombres en mm</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/staubli/read.py"/>
        <source>{0} is not a library of the project</source>
        <translation>{0} n&apos;est pas une bibliothèque du projet</translation>
    </message>
    <message>
        <location filename="../../freecad_am/macro/arguments.py"/>
        <source>{0} is not a list of objects; give one, such as [doc.Clamp]</source>
        <translation>{0} n’est pas une liste d’objets ; donnez-en une, telle que [doc.Clamp]</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/file.py"/>
        <source>{0} is not a list of {1}; write one in square brackets</source>
        <translation>{0} n&apos;est pas une liste de {1} ; écrivez-en une entre crochets</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/fields.py"/>
        <source>{0} is not a list; give [smallest, largest]{1}</source>
        <translation>{0} n&apos;est pas une liste ; donnez [le plus petit, le plus grand]{1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/fields.py"/>
        <source>{0} is not a list; give [x, y, z, RX, RY, RZ]{1}</source>
        <translation>{0} n&apos;est pas une liste ; donnez [x, y, z, RX, RY, RZ]{1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/macro/arguments.py"/>
        <source>{0} is not a list; give one, such as []</source>
        <translation>{0} n’est pas une liste ; donnez-en une, telle que []</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/file.py"/>
        <source>{0} is not a list; write one in square brackets</source>
        <translation>{0} n&apos;est pas une liste ; écrivez-en une entre crochets</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/obstacles.py"/>
        <source>{0} is not a name; use words without = and ;</source>
        <translation>{0} n&apos;est pas un nom ; utilisez des mots sans = ni ;</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/fields.py"/>
        <source>{0} is not a number; give one such as 0.1</source>
        <translation>{0} n&apos;est pas un nombre ; donnez-en un comme 0.1</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/field.py"/>
        <source>{0} is not a number; give one such as 2</source>
        <translation>{0} n&apos;est pas un nombre ; donnez-en un comme 2</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/field.py"/>
        <source>{0} is not a number; give one such as 2 or {1}</source>
        <translation>{0} n&apos;est pas un nombre ; donnez-en un comme 2 ou {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/fields/rows.py"/>
        <source>{0} is not a number; give one such as 2{1}</source>
        <translation>{0} n&apos;est pas un nombre ; donnez-en un comme 2{1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/calibration.py"/>
        <source>{0} is not a number; give the file as ur_calibration wrote it</source>
        <translation>{0} n&apos;est pas un nombre ; donnez le fichier tel que ur_calibration l&apos;a écrit</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/quantity.py"/>
        <source>{0} is not a number; give {1}</source>
        <translation>{0} n&apos;est pas un nombre ; donnez {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/curves/curve_table.py"/>
        <source>{0} is not a number; give {1} as a number with a point</source>
        <translation>{0} n&apos;est pas un nombre ; donnez {1} comme nombre à point décimal</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/file.py"/>
        <source>{0} is not a number; write one such as 12.5</source>
        <translation>{0} n&apos;est pas un nombre ; écrivez-en un comme 12.5</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/inspection.py"/>
        <source>{0} is not a pair of points; give x y z &gt; x y z in mm</source>
        <translation>{0} n&apos;est pas une paire de points ; donnez x y z &gt; x y z en mm</translation>
    </message>
    <message>
        <location filename="../../freecad_am/macro/arguments.py"/>
        <source>{0} is not a path; give one as a text, such as &quot;cup.step&quot;</source>
        <translation>{0} n’est pas un chemin ; donnez-en un sous forme de texte, tel que &quot;cup.step&quot;</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/cell.py"/>
        <source>{0} is not a point; give [x, y, z]</source>
        <translation>{0} n&apos;est pas un point ; donnez [x, y, z]</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/cell.py"/>
        <source>{0} is not a pose; give [x, y, z, RX, RY, RZ]</source>
        <translation>{0} n&apos;est pas une pose ; donnez [x, y, z, RX, RY, RZ]</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/external.py"/>
        <source>{0} is not a pose; give six numbers x y z RX RY RZ</source>
        <translation>{0} n&apos;est pas une pose ; donnez six nombres x y z RX RY RZ</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/field.py"/>
        <source>{0} is not a pose; give six numbers x y z RX RY RZ{1}</source>
        <translation>{0} n&apos;est pas une pose ; donnez six nombres x y z RX RY RZ{1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/fields/rows.py"/>
        <source>{0} is not a pose; give x y z in mm and RX RY RZ in deg</source>
        <translation>{0} n&apos;est pas une pose ; donnez x y z en mm et RX RY RZ en deg</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/fields/pendants.py"/>
        <source>{0} is not a pose; write such as: {1} X Y Z {2}</source>
        <translation>{0} n&apos;est pas une pose ; écrivez par exemple : {1} X Y Z {2}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/external.py"/>
        <source>{0} is not a pose; {1}</source>
        <translation>{0} n&apos;est pas une pose ; {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/refusals.py"/>
        <source>{0} is not a positioner of this controller; give {1}</source>
        <translation>{0} n&apos;est pas un positionneur de cette commande ; indiquez {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/staubli/read.py"/>
        <source>{0} is not a program of it, or calls itself</source>
        <translation>{0} n&apos;est pas un de ses programmes, ou s&apos;appelle lui-même</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/quantity.py"/>
        <source>{0} is not a quantity with a known unit; give {1}</source>
        <translation>{0} n&apos;est pas une grandeur d&apos;une unité connue ; donnez {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/quantity.py"/>
        <source>{0} is not a quantity; give {1}</source>
        <translation>{0} n&apos;est pas une grandeur ; donnez {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/file.py"/>
        <source>{0} is not a range; give the smaller one first, or null for endless</source>
        <translation>{0} n&apos;est pas une plage ; donnez d&apos;abord la plus petite valeur, ou null pour un axe sans fin</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/field.py"/>
        <source>{0} is not a range; give the smaller percentage first</source>
        <translation>{0} n&apos;est pas une plage ; donnez d&apos;abord le plus petit pourcentage</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/field.py"/>
        <source>{0} is not a range; give two angles, the smaller first</source>
        <translation>{0} n&apos;est pas une plage ; donnez deux angles, le plus petit d&apos;abord</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/field.py"/>
        <source>{0} is not a range; give two percentages, the smaller first</source>
        <translation>{0} n&apos;est pas une plage ; donnez deux pourcentages, le plus petit d&apos;abord</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/links/shape.py"/>
        <source>{0} is not a scale; give 1 for mm, 1000 for m</source>
        <translation>{0} n&apos;est pas une échelle ; donnez 1 pour mm, 1000 pour m</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/fields.py"/>
        <source>{0} is not a section; write keys below {1}:</source>
        <translation>{0} n&apos;est pas une section ; écrivez des clés sous {1} :</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/links/shape.py"/>
        <source>{0} is not a shape that can be drawn; use {1}</source>
        <translation>{0} n&apos;est pas une forme qui puisse être dessinée ; utilisez {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/denavit_hartenberg.py"/>
        <source>{0} is not a sign; use 1 or -1</source>
        <translation>{0} n&apos;est pas un signe ; utilisez 1 ou -1</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/read_process.py"/>
        <source>{0} is not a speed of the module</source>
        <translation>{0} n&apos;est pas une vitesse du module</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/read.py"/>
        <source>{0} is not a speed of the module, or the speed is given otherwise than by \T or \V</source>
        <translation>{0} n&apos;est pas une vitesse du module, ou le mouvement est donné autrement que par \T ou \V</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/field.py"/>
        <source>{0} is not a text; give one in quotes</source>
        <translation>{0} n’est pas un texte ; donnez-en un entre guillemets</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/fields.py"/>
        <source>{0} is not a text; give one, in quotes where it is a number</source>
        <translation>{0} n&apos;est pas un texte ; donnez-en un, entre guillemets si c&apos;est un nombre</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/file.py"/>
        <source>{0} is not a text; write one in quotes</source>
        <translation>{0} n&apos;est pas un texte ; écrivez-en un entre guillemets</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/modules.py"/>
        <source>{0} is not a tool of the module, or {1} no work object</source>
        <translation>{0} n&apos;est pas un outil du module, ou {1} n&apos;est pas un objet de travail</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/wall.py"/>
        <source>{0} is not a torus, cylinder or cone: a wall of several faces must be of one of these; choose one face</source>
        <translation>{0} n&apos;est ni un tore, ni un cylindre, ni un cône : une paroi de plusieurs faces doit être de l&apos;un d&apos;eux ; choisissez une seule face</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/touched.py"/>
        <source>{0} is not a touched point; {1}</source>
        <translation>{0} n&apos;est pas un point palpé ; {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/entries.py"/>
        <source>{0} is not a type of joint; use revolute or prismatic</source>
        <translation>{0} n&apos;est pas un type d&apos;articulation ; utilisez revolute ou prismatic</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/entries.py"/>
        <source>{0} is not a unit of path speeds; use {1}</source>
        <translation>{0} n&apos;est pas une unité de vitesse ; utilisez {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/entries.py"/>
        <source>{0} is not a unit vector; give one of length 1</source>
        <translation>{0} n&apos;est pas un vecteur unitaire ; donnez-en un de longueur 1</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/field.py"/>
        <source>{0} is not a whole number; give one such as 3</source>
        <translation>{0} n&apos;est pas un nombre entier ; donnez-en un comme 3</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/nc/parts.py"/>
        <source>{0} is not a word such as M7 or H2=1; give one for on and one for off</source>
        <translation>{0} n&apos;est pas un mot comme M7 ou H2=1 ; donnez-en un pour la marche et un pour l&apos;arrêt</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/columns.py"/>
        <source>{0} is not a zone of the module</source>
        <translation>{0} n&apos;est pas une zone du module</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/stage.py"/>
        <source>{0} is not a {1}; choose one</source>
        <translation>{0} n&apos;est pas : {1} ; choisissez-en un</translation>
    </message>
    <message>
        <location filename="../../freecad_am/interop/export.py"/>
        <source>{0} is not above 0; give a larger one</source>
        <translation>{0} n&apos;est pas supérieur à 0 ; donnez plus</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>{0} is not an axis; give a point and a direction such as [[0, 0, 0], [0, 0, 1]]</source>
        <translation>{0} n&apos;est pas un axe ; donnez un point et une direction comme [[0, 0, 0], [0, 0, 1]]</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/surface_feature.py"/>
        <source>{0} is not an edge of {1}; choose edges of it</source>
        <translation>{0} n&apos;est pas une arête de {1} ; choisissez ses arêtes</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/fanuc/parsed.py"/>
        <source>{0} is not an instruction</source>
        <translation>{0} n&apos;est pas une instruction</translation>
    </message>
    <message>
        <location filename="../../freecad_am/macro/arguments.py"/>
        <source>{0} is not an object of a document; give one, such as doc.Body</source>
        <translation>{0} n’est pas un objet d’un document ; donnez-en un, tel que doc.Body</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/file.py"/>
        <source>{0} is not an object with the keys {1}; write it as one in braces</source>
        <translation>{0} n&apos;est pas un objet avec les clés {1} ; écrivez-le comme tel entre accolades</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/file.py"/>
        <source>{0} is not an object; write one in braces</source>
        <translation>{0} n&apos;est pas un objet ; écrivez-en un entre accolades</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/obstacles.py"/>
        <source>{0} is not an obstacle; {1}</source>
        <translation>{0} n&apos;est pas un obstacle ; {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/stage.py"/>
        <source>{0} is not an {1}; choose one</source>
        <translation>{0} n&apos;est pas : {1} ; choisissez-en un</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/solids/plan.py"/>
        <source>{0} is not for curved layers, which grow along their normals; use local</source>
        <translation>{0} n&apos;est pas pour les couches courbes, qui croissent suivant leurs normales ; utilisez local</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/solids/plan.py"/>
        <source>{0} is not for solids on a hub, which grow along its normals; use local</source>
        <translation>{0} n&apos;est pas pour les solides sur moyeu, qui croissent le long de ses normales ; utilisez local</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/shapes/part_file.py"/>
        <source>{0} is not found among the objects with a shape ({1}); name one</source>
        <translation>{0} n&apos;est pas trouvé parmi les objets à forme ({1}) ; nommez-en un</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/external.py"/>
        <source>{0} is not known; built in are {1}; or give the path of a machine file or a URDF</source>
        <translation>{0} n&apos;est pas connu ; sont intégrés {1} ; ou donnez le chemin d&apos;un fichier de machine ou d&apos;un URDF</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/fields.py"/>
        <source>{0} is not known; did you mean {1}? use one of {2}</source>
        <translation>{0} n&apos;est pas connu ; vouliez-vous dire {1} ? utilisez l&apos;une des valeurs {2}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/fields.py"/>
        <source>{0} is not known; give {1} or {2}</source>
        <translation>{0} n&apos;est pas connu ; donnez {1} ou {2}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/field.py"/>
        <source>{0} is not known; use one of {1}</source>
        <translation>{0} n&apos;est pas connu ; utilisez l&apos;un de {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/catalogue.py"/>
        <source>{0} is not known; use one of {1}, or none</source>
        <translation>{0} n&apos;est pas connu ; utilisez l&apos;un de {1}, ou none</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/near_names.py"/>
        <source>{0} is not known; {1}</source>
        <translation>{0} n&apos;est pas connu ; {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/yaskawa/read.py"/>
        <source>{0} is not position {1}</source>
        <translation>{0} n&apos;est pas la position {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/yaskawa/read.py"/>
        <source>{0} is not position {1} of {2}</source>
        <translation>{0} n&apos;est pas la position {1} de {2}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/point_file.py"/>
        <source>{0} is not read as points; use {1}</source>
        <translation>{0} n&apos;est pas lu comme des points ; utilisez {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/files/read.py"/>
        <source>{0} is not read; use {1}</source>
        <translation>{0} n&apos;est pas lu ; utilisez {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/entries.py"/>
        <source>{0} is not the length of an arm; give more than 0 mm</source>
        <translation>{0} n&apos;est pas la longueur d&apos;un bras ; donnez plus de 0 mm</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/machine.py"/>
        <source>{0} is not the name of the file, {1}; rename it</source>
        <translation>{0} n&apos;est pas le nom du fichier, {1} ; renommez-le</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/shapes/chosen.py"/>
        <source>{0} is not there any more since the part changed; choose the edges again</source>
        <translation>{0} n’existe plus depuis que la pièce a changé ; choisissez les arêtes à nouveau</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/shapes/chosen.py"/>
        <source>{0} is not there any more since the part changed; choose the faces again</source>
        <translation>{0} n’existe plus depuis que la pièce a changé ; choisissez les faces à nouveau</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/shapes/nested.py"/>
        <source>{0} is not there in {1}; choose it in the 3D view, or by the object that it belongs to</source>
        <translation>{0} n’existe pas dans {1} ; choisissez-le dans la vue 3D, ou par l’objet auquel il appartient</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/read.py"/>
        <source>{0} is not there, has no routine {1}, is run already, or loaded while depositing</source>
        <translation>{0} manque, n&apos;a pas de routine {1}, a déjà été exécuté, ou est chargé pendant le dépôt</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/field.py"/>
        <source>{0} is not true or false; give one of them</source>
        <translation>{0} n&apos;est ni vrai ni faux ; donnez l&apos;un des deux</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/linuxcnc/read.py"/>
        <source>{0} is not understood</source>
        <translation>{0} n&apos;est pas compris</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/fields/expressions.py"/>
        <source>{0} is not understood ({1}); write it as in {2}Spreadsheet.height / 2</source>
        <translation>{0} n&apos;est pas compris ({1}) ; écrivez-le comme {2}Spreadsheet.height / 2</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/linuxcnc/read.py"/>
        <source>{0} is not understood here</source>
        <translation>{0} n&apos;est pas compris ici</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/linuxcnc/read.py"/>
        <source>{0} is not understood, or a second output is switched</source>
        <translation>{0} n&apos;est pas compris, ou une seconde sortie est commandée</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/modules.py"/>
        <source>{0} is not understood, or declares a name again</source>
        <translation>{0} n&apos;est pas compris, ou déclare un nom une seconde fois</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/tree.py"/>
        <source>{0} is not understood: {1}; write it as in a job file</source>
        <translation>{0} n&apos;est pas compris : {1} ; écrivez-le comme dans un fichier de travail</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/toolpath.py"/>
        <source>{0} is not understood; give a JSON mapping with keys of {1}</source>
        <translation>{0} n&apos;est pas compris ; donnez un objet JSON avec des clés parmi {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>{0} is not understood; give layer/bead:constant:slope with up to {1} coefficients in deg and deg per turn, such as 12/0:-35:360; * stands for every other bead</source>
        <translation>{0} n&apos;est pas compris ; donnez couche/cordon:constante:pente avec jusqu&apos;à {1} coefficients en deg et deg par tour, comme 12/0:-35:360 ; * vaut pour tout autre cordon</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/fields/rows.py"/>
        <source>{0} is not understood; give {1}</source>
        <translation>{0} n&apos;est pas compris ; donnez {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/quantity.py"/>
        <source>{0} is not understood; {1}</source>
        <translation>{0} n&apos;est pas compris ; {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/staubli/read.py"/>
        <source>{0} is not {1} data of the project, or has not so many values</source>
        <translation>{0} n&apos;est pas une donnée {1} du projet, ou n&apos;a pas autant de valeurs</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/entries.py"/>
        <source>{0} is not {1}; give more than 0, or null where not known</source>
        <translation>{0} n&apos;est pas {1} ; donnez plus de 0, ou null si elle n&apos;est pas connue</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/fields/properties.py"/>
        <source>{0} is out of range; give -360 to 360 deg</source>
        <translation>{0} est hors de la plage ; donnez de -360 à 360 deg</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/field.py"/>
        <source>{0} is out of range; give {1}</source>
        <translation>{0} est hors de la plage ; donnez {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/read.py"/>
        <source>{0} is reached before the move before it ends</source>
        <translation>{0} est atteint avant la fin du mouvement qui précède</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/kuka/read.py"/>
        <source>{0} is read ahead of the motion: no wait stands before it</source>
        <translation>{0} est lu en avance sur le mouvement : aucune attente ne le précède</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/kuka/read.py"/>
        <source>{0} is run already, or called while depositing</source>
        <translation>{0} a déjà été exécuté, ou est appelé pendant le dépôt</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/layers/planes/stacking.py"/>
        <source>{0} is stacked along ({1}, {2}, {3}): {4} mm^2 of it lean over nothing by more than {5} deg, and it is {6} mm high</source>
        <translation>{0} est empilé suivant ({1}, {2}, {3}) : {4} mm^2 en surplombent le vide de plus de {5} deg, et sa hauteur est de {6} mm</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/layers/planes/stacking.py"/>
        <source>{0} is stacked along ({1}, {2}, {3}): {4} mm^2 of it lean over nothing by more than {5} deg, and it is {6} mm high; along (0, 0, 1) it would be {7} mm^2 and {8} mm</source>
        <translation>{0} est empilé suivant ({1}, {2}, {3}) : {4} mm^2 en surplombent le vide de plus de {5} deg, et sa hauteur est de {6} mm ; suivant (0, 0, 1) ce serait {7} mm^2 et {8} mm</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/external.py"/>
        <source>{0} is the machine of the cell, which cannot carry itself; name what stands beside it</source>
        <translation>{0} est la machine de la cellule, qui ne peut pas se porter elle-même ; nommez ce qui se trouve à côté</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/joints.py"/>
        <source>{0} is there twice; give each bead one</source>
        <translation>{0} y est deux fois ; donnez chaque cordon une fois</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/bead_classes.py"/>
        <source>{0} is there twice; write all of it in one place</source>
        <translation>{0} y est deux fois ; écrivez le tout en un seul endroit</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/fields.py"/>
        <source>{0} is too large; give {1}</source>
        <translation>{0} est trop grand ; donnez {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/filled.py"/>
        <source>{0} is without 100 %, the usual width; include it</source>
        <translation>{0} ne contient pas 100 %, la largeur habituelle ; incluez-la</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/parts.py"/>
        <source>{0} is woven and has {1} points with its approach, and whether a weave goes on in another program was not confirmed; allow more points in one, or a larger chord error</source>
        <translation>{0} est balayé et a {1} points avec son approche, et il n&apos;a pas été confirmé qu&apos;un balayage se poursuit dans un autre programme ; permettez plus de points dans un seul, ou une plus grande erreur de corde</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/curves/curve_table.py"/>
        <source>{0} is {1}; give a number of at most {2}</source>
        <translation>{0} est {1} ; donnez un nombre d&apos;au plus {2}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/yaskawa/read.py"/>
        <source>{0} jobs are called by none of the others, expected one</source>
        <translation>{0} jobs ne sont appelés par aucun autre, un seul est attendu</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/deposit/support.py"/>
        <source>{0} layers more have beads over nothing, {1} mm of them</source>
        <translation>{0} autres couches ont des cordons au-dessus du vide, sur {1} mm</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/revolution/turn.py"/>
        <source>{0} leave more than one opening around the axis; choose one of them</source>
        <translation>{0} laissent plus d&apos;une ouverture autour de l&apos;axe ; choisissez-en une</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/clearance.py"/>
        <source>{0} links that move with their axes, every {1} deg of the whole motion, the nozzle every mm: they touch nothing</source>
        <translation>{0} corps qui bougent avec leurs axes, tous les {1} deg du mouvement entier, la buse tous les mm : ils ne touchent rien</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/clearance.py"/>
        <source>{0} links that move with their axes, every {1} deg of the whole motion, the nozzle every mm: they touch {2} with {3}</source>
        <translation>{0} corps qui bougent avec leurs axes, tous les {1} deg du mouvement entier, la buse tous les mm : ils touchent {2} avec {3}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/stage.py"/>
        <source>{0} links to nothing, what it showed is gone or was not loaded; choose another {1}</source>
        <translation>{0} ne lie à rien, ce qu&apos;il montrait a disparu ou n&apos;a pas été chargé ; choisissez un autre {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/staubli/post.py"/>
        <source>{0} may be a program of this very job; call one of another name</source>
        <translation>{0} peut être un programme de ce travail même ; appelez-en un d&apos;un autre nom</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/fields/rows.py"/>
        <source>{0} may be read in two ways; write decimals with a point and one kind of separator, as in 10.5 20.5</source>
        <translation>{0} peut se lire de deux façons ; écrivez les décimales avec un point et une seule sorte de séparateur, comme dans 10.5 20.5</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/nc/parts.py"/>
        <source>{0} means something else to the controller; use another word</source>
        <translation>{0} veut dire autre chose pour la commande ; utilisez un autre mot</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/external.py"/>
        <source>{0} mechanisms carry the robot; give one track</source>
        <translation>{0} mécanismes portent le robot ; donnez un seul rail</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/first_layer.py"/>
        <source>{0} meets {1} in {2} loops; layers start at the uppermost</source>
        <translation>{0} rencontre {1} en {2} boucles ; les couches commencent à la plus haute</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/mesh/repair.py"/>
        <source>{0} missing triangles were put in</source>
        <translation>{0} triangles manquants ont été ajoutés</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/slicing/iso_height.py"/>
        <source>{0} mm is more than the wall is high ({1} mm); give a smaller one, or layers along the wall (spacing: arc-length)</source>
        <translation>{0} mm sont plus que la hauteur de la paroi ({1} mm) ; donnez moins, ou des couches le long de la paroi (spacing: arc-length)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/slicing/arc_length.py"/>
        <source>{0} mm is more than the wall is long ({1} mm); give a smaller one</source>
        <translation>{0} mm sont plus que la longueur de la paroi ({1} mm) ; donnez moins</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/mesh/file_unit.py"/>
        <source>{0} mm is not a unit; give the length of one unit of the file, as 25.4 mm</source>
        <translation>{0} mm n&apos;est pas une unité ; donnez la longueur d&apos;une unité du fichier, comme 25.4 mm</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/layers/curved/field.py"/>
        <source>{0} mm is too fine for curved layers of {1}, {2} cm3; give at least {3} mm, or layers: planes</source>
        <translation>{0} mm est trop fin pour des couches courbes de {1}, {2} cm3 ; donnez au moins {3} mm, ou layers: planes</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/layers/planes/field.py"/>
        <source>{0} mm is too much for {1}, {2} mm high along strategy.direction (the highest place is at {3}): no layer is cut in its {4}; give at most {5} mm</source>
        <translation>{0} mm est trop pour {1}, haut de {2} mm suivant strategy.direction (le point le plus haut est en {3}) : aucune couche n&apos;est coupée ({4}) ; donnez {5} mm au plus</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/layers/along/field.py"/>
        <source>{0} mm is too much for {1}, {2} mm long along the guide: no layer is cut in its {3}; give at most {4} mm</source>
        <translation>{0} mm, c&apos;est trop pour {1}, long de {2} mm le long du guide : aucune couche n&apos;est coupée en son {3} ; donnez au plus {4} mm</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/size.py"/>
        <source>{0} mm makes about {1} layers, and more than {2} cannot be worked with; give at least {3} mm</source>
        <translation>{0} mm font environ {1} couches, et il n&apos;est pas possible de travailler avec plus de {2} ; donnez au moins {3} mm</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/size.py"/>
        <source>{0} mm makes about {1} points, and more than {2} cannot be worked with; give at least {3} mm</source>
        <translation>{0} mm font environ {1} points, et il n&apos;est pas possible de travailler avec plus de {2} ; donnez au moins {3} mm</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/deposit/support.py"/>
        <source>{0} mm of beads lie over nothing, {1} mm of them in a row from here: what is below is more than {2} mm away, or they overhang it by more than half of their width; deposit what carries them first, let the part grow from another side, or leave them out</source>
        <translation>{0} mm de cordons sont au-dessus du vide, dont {1} mm à la suite à partir d&apos;ici : ce qui est dessous est à plus de {2} mm, ou ils le débordent de plus de la moitié de leur largeur ; déposez d&apos;abord ce qui les porte, faites croître la pièce d&apos;un autre côté, ou laissez-les de côté</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/support.py"/>
        <source>{0} mm of the first layer lie over the edge of the platform, up to {1} mm beyond it; move the part, or set cell.platform_diameter to what there is (0 for none)</source>
        <translation>{0} mm de la première couche dépassent du bord du plateau, jusqu’à {1} mm au-delà ; déplacez la pièce, ou donnez à cell.platform_diameter sa vraie valeur (0 pour aucun)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/support.py"/>
        <source>{0} mm of the first layer lie over the edge of the platform, up to {1} mm beyond it; put the part on its middle by cell.mount: feature, move it, or set cell.platform_diameter to what there is (0 for none)</source>
        <translation>{0} mm de la première couche dépassent du bord du plateau, jusqu’à {1} mm au-delà ; posez la pièce sur son milieu par cell.mount: feature, déplacez-la, ou donnez à cell.platform_diameter sa vraie valeur (0 pour aucun)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/support.py"/>
        <source>{0} mm of the first layer lie up to {1} mm above the platform, over nothing; put the part on it by cell.mount: feature, move it in its file, or name what it grows on as its substrate</source>
        <translation>{0} mm de la première couche se trouvent jusqu&apos;à {1} mm au-dessus du plateau, au-dessus du vide ; posez la pièce dessus par cell.mount: feature, déplacez-la dans son fichier, ou donnez comme substrat ce sur quoi elle croît</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/revolution/plan.py"/>
        <source>{0} mm of the height are left at the top, less than a layer</source>
        <translation>{0} mm de la hauteur restent en haut, moins qu&apos;une couche</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/revolution/plan.py"/>
        <source>{0} mm of the wall are left at the top, less than a layer</source>
        <translation>{0} mm de la paroi restent en haut, moins qu&apos;une couche</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/torch.py"/>
        <source>{0} mm over its tip it reaches {1} mm from its axis, the nozzle as a cone {2} mm, and it is the cone that is kept clear of the deposit; give a larger cell.nozzle.diameter, or a smaller cell.nozzle.length</source>
        <translation>à {0} mm de sa pointe elle s&apos;étend à {1} mm de son axe, la buse en cône à {2} mm, et c&apos;est le cône qui est tenu à l&apos;écart du dépôt ; donnez un cell.nozzle.diameter plus grand, ou une cell.nozzle.length plus petite</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/torch.py"/>
        <source>{0} mm over its tip it reaches {1} mm from its axis, the nozzle as a cone {2} mm, and it is the cone that is kept clear of the deposit; give cell.nozzle.half_angle of {3} deg at least, or a smaller cell.nozzle.length</source>
        <translation>à {0} mm de sa pointe elle s&apos;étend à {1} mm de son axe, la buse en cône à {2} mm, et c&apos;est le cône qui est tenu à l&apos;écart du dépôt ; donnez un cell.nozzle.half_angle d&apos;au moins {3} deg, ou une cell.nozzle.length plus petite</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/yaskawa/post.py"/>
        <source>{0} mm/s cannot be written in {1}; use {2} to {3} mm/s</source>
        <translation>{0} mm/s ne s&apos;écrit pas en {1} ; utilisez {2} à {3} mm/s</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/refusals.py"/>
        <source>{0} mm/s cannot be written; use a speed between {1} and {2} mm/s</source>
        <translation>{0} mm/s ne peuvent pas être écrits ; utilisez une vitesse entre {1} et {2} mm/s</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/staubli/numbers.py"/>
        <source>{0} mm/s cannot be written; use at least {1} mm/s</source>
        <translation>{0} mm/s ne peuvent pas être écrits ; utilisez au moins {1} mm/s</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/nc/numbers.py"/>
        <source>{0} mm/s cannot be written; use {1} to {2} mm/s</source>
        <translation>{0} mm/s ne peuvent pas être écrits ; utilisez {1} à {2} mm/s</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/model/material.py"/>
        <source>{0} mm/s is more than the fastest, {1} mm/s; give the slower speed here</source>
        <translation>{0} mm/s est plus que le plus rapide, {1} mm/s ; donnez ici la vitesse la plus lente</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/inspection.py"/>
        <source>{0} mm: {1} mm</source>
        <translation>{0} mm : {1} mm</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/layers/over_and_under.py"/>
        <source>{0} mm^2 lean out over the layer below by more than {1} deg, the largest piece at {2}; deposit what carries it first, choose another strategy.direction, or raise strategy.max_overhang</source>
        <translation>{0} mm^2 surplombent la couche du dessous de plus de {1} deg, le plus grand morceau en {2} ; déposez d&apos;abord ce qui le porte, choisissez une autre strategy.direction, ou augmentez strategy.max_overhang</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/read.py"/>
        <source>{0} modules have a routine main, expected one</source>
        <translation>{0} modules ont une routine main, un seul était attendu</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/fanuc/numbers.py"/>
        <source>{0} moves take {1} s in all and cannot be shorter than 1 ms each; use a larger chord error or a lower speed</source>
        <translation>{0} mouvements prennent {1} s en tout et ne peuvent pas durer moins de 1 ms chacun ; prenez une plus grande erreur de corde ou une vitesse plus basse</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/entries.py"/>
        <source>{0} must be 1 or -1 each; give one for each joint</source>
        <translation>{0} doivent être 1 ou -1 chacun ; donnez-en un par articulation</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/entries.py"/>
        <source>{0} must lie within +-180; give the same angles in that range</source>
        <translation>{0} doit être compris entre -180 et 180 ; donnez les mêmes angles dans cette plage</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/shapes/nested.py"/>
        <source>{0} names faces or edges of several objects ({1}, {2}); choose those of one</source>
        <translation>{0} désigne des faces ou des arêtes de plusieurs objets ({1}, {2}) ; choisissez celles d’un seul</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/external.py"/>
        <source>{0} names no external axes; {1}</source>
        <translation>{0} ne désigne pas d&apos;axes externes ; {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/proposed_family.py"/>
        <source>{0} names the edges that it starts from</source>
        <translation>{0} nomme les arêtes d&apos;où elle part</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/inspect.py"/>
        <source>{0} of its points lie on {1}; choose the object that was measured, its unit, or pairs of points to begin with</source>
        <translation>{0} de ses points sont sur {1} ; choisissez l&apos;objet qui a été mesuré, son unité, ou des paires de points pour commencer</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/scan_checks.py"/>
        <source>{0} of its {1} points lie within {2} mm of {3}, at least {4} have to; half of them are farther off than {5} mm. It reaches over {6} mm, {7} over {8} mm: scan this part, crop the scan to it, check its unit, or raise substrate.scan_within</source>
        <translation>{0} de ses {1} points sont à moins de {2} mm de {3}, il en faut au moins {4} ; la moitié en est plus loin que {5} mm. Elle s&apos;étend sur {6} mm, {7} sur {8} mm : numérisez cette pièce, rognez la numérisation à celle-ci, vérifiez son unité, ou augmentez substrate.scan_within</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/registration.py"/>
        <source>{0} of the points cannot be left out; give 0 or more and less than 0.5</source>
        <translation>une part de {0} des points ne peut pas être écartée ; donnez 0 ou plus et moins de 0.5</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/obstacles.py"/>
        <source>{0} of them are called {1}; give each its own name</source>
        <translation>{0} d&apos;entre eux s&apos;appellent {1} ; donnez à chacun son propre nom</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/solids/notes.py"/>
        <source>{0} of {1} beads are deposited at {2} to {3} mm/s instead of {4} mm/s, for one wire feed to make them {5}; the speed follows that along them</source>
        <translation>{0} des {1} cordons sont déposés à {2} à {3} mm/s au lieu de {4} mm/s, pour qu’un même dévidage leur donne {5} ; la vitesse la suit le long d’eux</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/solids/notes.py"/>
        <source>{0} of {1} beads are deposited at {2} to {3} mm/s, for one wire feed to make them {4}; the speed follows that along them</source>
        <translation>{0} des {1} cordons sont déposés à {2} à {3} mm/s, pour qu’un même dévidage leur donne {4} ; la vitesse la suit le long d’eux</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/findings.py"/>
        <source>{0} of {1} directions cannot be turned to the torch by this machine; tilt less, or mount the part otherwise</source>
        <translation>{0} de {1} directions ne peuvent pas être tournées vers la torche par cette machine ; inclinez moins, ou montez la pièce autrement</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/walls/beads.py"/>
        <source>{0} of {1} fronts have corners, first layer {2}; the sharpest turns by {3} deg. The robot slows down there</source>
        <translation>{0} de {1} fronts ont des angles, d&apos;abord la couche {2} ; le plus vif tourne de {3} deg. Le robot y ralentit</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/revolution/wall.py"/>
        <source>{0} of {1} is a step of {2} mm in the wall; it is kept</source>
        <translation>{0} de {1} est une marche de {2} mm dans la paroi ; elle est gardée</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/proposed_family.py"/>
        <source>{0} of {1} is chosen, which the rest of it stands on</source>
        <translation>{0} de {1} est choisie, sur laquelle se dresse le reste</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/shapes/nested.py"/>
        <source>{0} of {1} is not certain: FreeCAD has what is in a group of it twice, and numbers both; choose it of the object that it belongs to</source>
        <translation>{0} de {1} n’est pas certain : FreeCAD a deux fois ce qui est dans un de ses groupes, et numérote les deux ; choisissez-le dans l’objet auquel il appartient</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/shapes/chosen.py"/>
        <source>{0} of {1} is not the edge that was chosen: that edge is {2} now, as FreeCAD renumbers edges when a part changes; choose the edges again, or confirm them: OK in the panel with nothing else entered</source>
        <translation>{0} de {1} n’est pas l’arête choisie : celle-ci est maintenant {2}, car FreeCAD renumérote les arêtes quand une pièce change ; choisissez les arêtes à nouveau, ou confirmez-les : OK dans le panneau sans rien saisir d’autre</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/shapes/chosen.py"/>
        <source>{0} of {1} is not the face that was chosen: that face is {2} now, as FreeCAD renumbers faces when a part changes; choose the faces again, or confirm them: OK in the panel with nothing else entered</source>
        <translation>{0} de {1} n’est pas la face choisie : celle-ci est maintenant {2}, car FreeCAD renumérote les faces quand une pièce change ; choisissez les faces à nouveau, ou confirmez-les : OK dans le panneau sans rien saisir d’autre</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/shapes/nested.py"/>
        <source>{0} of {1} is {2} of {3}; choose it of that object</source>
        <translation>{0} de {1} est {2} de {3} ; choisissez-la sur cet objet</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/revolution/plan.py"/>
        <source>{0} of {1} layers are more than 20 % off the layer height of {2} mm, first layer {3}; layer {4} is {5} mm from the one below; layers along the wall (spacing: arc-length) are even</source>
        <translation>{0} de {1} couches s&apos;écartent de plus de 20 % de la hauteur de couche de {2} mm, d&apos;abord la couche {3} ; la couche {4} est à {5} mm de celle du dessous ; des couches le long de la paroi (spacing: arc-length) sont égales</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/layers/along/field.py"/>
        <source>{0} of {1} layers are not as high everywhere as asked for: layer {2} is {3} to {4} mm high, farthest off the {5} mm at {6}; strategy.band allows {7} %, and {8} % would be needed: raise it, or choose a guide in the middle of the part or one that bends less</source>
        <translation>{0} couches sur {1} ne sont pas partout de la hauteur demandée : la couche {2} a {3} à {4} mm, le plus loin des {5} mm en {6} ; strategy.band permet {7} %, et il faudrait {8} % : augmentez-le, ou choisissez un guide au milieu de la pièce ou moins courbé</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/shapes/chosen.py"/>
        <source>{0} of {1} lies another way than when it was chosen, so it may be another edge, as FreeCAD renumbers edges when a part changes; choose the edges again, or confirm them: OK in the panel with nothing else entered</source>
        <translation>{0} de {1} est orientée autrement que lorsqu’elle a été choisie, c’est donc peut-être une autre arête, car FreeCAD renumérote les arêtes quand une pièce change ; choisissez les arêtes à nouveau, ou confirmez-les : OK dans le panneau sans rien saisir d’autre</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/shapes/chosen.py"/>
        <source>{0} of {1} lies another way than when it was chosen, so it may be another face, as FreeCAD renumbers faces when a part changes; choose the faces again, or confirm them: OK in the panel with nothing else entered</source>
        <translation>{0} de {1} est orientée autrement que lorsqu’elle a été choisie, c’est donc peut-être une autre face, car FreeCAD renumérote les faces quand une pièce change ; choisissez les faces à nouveau, ou confirmez-les : OK dans le panneau sans rien saisir d’autre</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/deposit/on_part.py"/>
        <source>{0} of {1} places checked are off the part, this one at {2} by {3} mm, and {4} mm are allowed: this toolpath deposits something else; choose another strategy, or other faces, and report the part</source>
        <translation>{0} des {1} endroits regardés sont hors de la pièce, celui-ci en {2} de {3} mm, et {4} mm sont permis : cette trajectoire dépose autre chose ; choisissez une autre stratégie, ou d&apos;autres faces, et signalez la pièce</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/findings.py"/>
        <source>{0} of {1} points cannot be reached with this branch; move the deposition point, choose another branch or tilt less</source>
        <translation>{0} de {1} points ne peuvent pas être atteints avec cette branche ; déplacez le point de dépôt, choisissez une autre branche ou inclinez moins</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/findings.py"/>
        <source>{0} of {1} points cannot be reached with this branch; move the positioner, choose another branch or tilt less</source>
        <translation>{0} de {1} points ne peuvent pas être atteints avec cette branche ; déplacez le positionneur, choisissez une autre branche ou inclinez moins</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/solids/notes.py"/>
        <source>{0} of {1} solids or groups of solids get a single layer, on the hub: they are no higher than strategy.layer_height, {2} mm</source>
        <translation>{0} de {1} solides ou groupes de solides ne reçoivent qu&apos;une couche, sur le moyeu : ils ne sont pas plus hauts que strategy.layer_height, {2} mm</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/shapes/chosen.py"/>
        <source>{0} of {1} was {2} when it was chosen and is {3} now, so it may be another edge, as FreeCAD renumbers edges when a part changes; choose the edges again, or confirm them: OK in the panel with nothing else entered</source>
        <translation>{0} de {1} était {2} quand elle a été choisie et est maintenant {3}, c’est donc peut-être une autre arête, car FreeCAD renumérote les arêtes quand une pièce change ; choisissez les arêtes à nouveau, ou confirmez-les : OK dans le panneau sans rien saisir d’autre</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/shapes/chosen.py"/>
        <source>{0} of {1} was {2} when it was chosen and is {3} now, so it may be another face, as FreeCAD renumbers faces when a part changes; choose the faces again, or confirm them: OK in the panel with nothing else entered</source>
        <translation>{0} de {1} était {2} quand elle a été choisie et est maintenant {3}, c’est donc peut-être une autre face, car FreeCAD renumérote les faces quand une pièce change ; choisissez les faces à nouveau, ou confirmez-les : OK dans le panneau sans rien saisir d’autre</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/fanuc/read.py"/>
        <source>{0} or CNT{1} is not understood here</source>
        <translation>{0} ou CNT{1} n&apos;est pas compris ici</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/cell.py"/>
        <source>{0} or {1}</source>
        <translation>{0} ou {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/clearance/helpful.py"/>
        <source>{0} out of the way</source>
        <translation>{0} hors du chemin</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/registration.py"/>
        <source>{0} pairs of points; give three or more</source>
        <translation>{0} paires de points ; donnez-en trois ou plus</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/mesh/repair.py"/>
        <source>{0} pairs of triangles cross, as at {1}, and what any of them enclose counts as inside</source>
        <translation>{0} paires de triangles se croisent, par exemple en {1}, et ce que l&apos;un d&apos;eux enferme compte comme intérieur</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/mesh/orientation.py"/>
        <source>{0} pieces that enclose nothing were dropped</source>
        <translation>{0} morceaux qui n&apos;enferment rien ont été écartés</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/work_offset.py"/>
        <source>{0} point(s) do not determine where a part stands; touch {1} or more, far from one another and not on a line</source>
        <translation>{0} point(s) ne disent pas où se trouve une pièce ; palpez-en {1} ou plus, éloignés les uns des autres et pas sur une droite</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/promise.py"/>
        <source>{0} points</source>
        <translation>{0} points</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/registration.py"/>
        <source>{0} points do not hold a part; measure {1} or more all over</source>
        <translation>{0} points ne tiennent pas une pièce ; mesurez-en {1} ou plus partout</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/roundness.py"/>
        <source>{0} points do not make a circle; measure {1} or more</source>
        <translation>{0} points ne font pas un cercle ; mesurez-en {1} ou plus</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/roundness.py"/>
        <source>{0} points do not make a sphere; measure {1} or more</source>
        <translation>{0} points ne font pas une sphère ; mesurez-en {1} ou plus</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/inspect.py"/>
        <source>{0} points lie past the edges of {1} and count nowhere</source>
        <translation>{0} points sont au-delà des bords de {1} et ne comptent nulle part</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/figures.py"/>
        <source>{0} points lie within {1} mm of the height {2} mm; measure more there, choose other heights, or a wider band</source>
        <translation>{0} points sont à {1} mm au plus de la hauteur {2} mm ; mesurez-y davantage, choisissez d&apos;autres hauteurs, ou une bande plus large</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/inspect.py"/>
        <source>{0} points were left out of the fit, the farthest off; the figures have them</source>
        <translation>{0} points ont été laissés hors de l&apos;ajustement, les plus écartés ; les chiffres les contiennent</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/point_file.py"/>
        <source>{0} points without finite coordinates are left out</source>
        <translation>{0} points sans coordonnées finies sont laissés de côté</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/fanuc/read.py"/>
        <source>{0} programs are called by none of the others, expected one</source>
        <translation>{0} programmes ne sont appelés par aucun autre, un seul attendu</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/preflight/promise.py"/>
        <source>{0} rapids</source>
        <translation>{0} rapides</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/revolution/platform.py"/>
        <source>{0} reaches {1} mm below the platform, at {2}</source>
        <translation>{0} descend à {1} mm au-dessous du plateau, en {2}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/model/bead_model.py"/>
        <source>{0} row {1}</source>
        <translation>{0} ligne {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/model/bead_model.py"/>
        <source>{0} row {1} (line {2})</source>
        <translation>{0} ligne {1} (ligne {2} du fichier)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/deposit/balance.py"/>
        <source>{0} solid(s) ({1}) of {2} are not deposited</source>
        <translation>{0} solide(s) ({1}) de {2} ne sont pas déposés</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/deposit/balance.py"/>
        <source>{0} solid(s) ({1}), about {2} cm3 of the {3} cm3 of {4}, are not deposited</source>
        <translation>{0} solide(s) ({1}), environ {2} cm3 des {3} cm3 de {4}, ne sont pas déposés</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/hub.py"/>
        <source>{0} solids on {1} ({2})</source>
        <translation>{0} solides sur {1} ({2})</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/mesh/orientation.py"/>
        <source>{0} solids were inside out and were turned</source>
        <translation>{0} solides étaient retournés et ont été remis à l&apos;endroit</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/kuka/read.py"/>
        <source>{0} stands among the lines of another instruction</source>
        <translation>{0} se trouve parmi les lignes d&apos;une autre instruction</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/proposed_family.py"/>
        <source>{0} stands on a cylinder or cone of {1}</source>
        <translation>{0} se dresse sur un cylindre ou un cône de {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/ur/read.py"/>
        <source>{0} stands outside of its function</source>
        <translation>{0} est en dehors de sa fonction</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/linuxcnc/read.py"/>
        <source>{0} stands there twice</source>
        <translation>{0} y est deux fois</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/external.py"/>
        <source>{0} stands there twice; leave one of them out, or give a second one of the same kind a pose of its own</source>
        <translation>{0} s&apos;y trouve deux fois ; retirez-en un, ou donnez au second du même type sa propre pose</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/walls/patch_wall.py"/>
        <source>{0} starts in {1} curves, about {2}: layers grow from all of them; choose the edges to start from if only some are meant</source>
        <translation>{0} commence en {1} courbes, vers {2} : les couches croissent à partir de toutes ; choisissez les arêtes de départ si seules certaines sont voulues</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/mesh/file_unit.py"/>
        <source>{0} states its own unit; leave out the scale, which is for STL and OBJ</source>
        <translation>{0} dit lui-même son unité ; retirez l&apos;échelle, elle est pour STL et OBJ</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/urdf/cell.py"/>
        <source>{0} takes all of the file; leave out base and tip of the machine, or name the mechanisms one by one</source>
        <translation>{0} prend tout le fichier ; retirez base et tip de la machine, ou nommez les mécanismes un par un</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/machine.py"/>
        <source>{0} takes no calibration; those of Universal Robots do: leave it out</source>
        <translation>{0} n&apos;admet pas d&apos;étalonnage ; seuls les robots d&apos;Universal Robots en ont un : omettez-le</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/staubli/moves.py"/>
        <source>{0} that stands in the world</source>
        <translation>{0} qui est dans le monde</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/staubli/moves.py"/>
        <source>{0} that stands on the flange</source>
        <translation>{0} qui est sur la bride</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/field.py"/>
        <source>{0} to {1}</source>
        <translation>{0} à {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/walls/mesh_wall.py"/>
        <source>{0} triangles that cross were cut out, as at {1}, which left holes of up to {2} mm across</source>
        <translation>{0} triangles qui se croisent ont été retirés, par exemple en {1}, ce qui a laissé des trous larges de {2} mm au plus</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/mesh/repair.py"/>
        <source>{0} triangles that were there twice were dropped</source>
        <translation>{0} triangles présents en double ont été écartés</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/mesh/orientation.py"/>
        <source>{0} triangles were turned to agree with their neighbours</source>
        <translation>{0} triangles ont été retournés pour s&apos;accorder avec leurs voisins</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/mesh/repair.py"/>
        <source>{0} triangles without an area were dropped</source>
        <translation>{0} triangles sans surface ont été écartés</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/proposed_family.py"/>
        <source>{0} turns about one axis, and its wall is one bead of {1} mm</source>
        <translation>{0} tourne autour d&apos;un axe, et sa paroi est un cordon de {1} mm</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/revolution/turn.py"/>
        <source>{0} turns {1} and {2} {3}; choose faces that turn alike</source>
        <translation>{0} tourne {1} et {2} {3} ; choisissez des faces qui tournent pareillement</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/files/three_mf.py"/>
        <source>{0} unpacks to more than {1} MB; export it with a coarser mesh</source>
        <translation>{0} occupe plus de {1} Mo une fois décomprimé ; exportez-le avec un maillage plus grossier</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/siemens/read.py"/>
        <source>{0} with a move is not understood</source>
        <translation>{0} avec un mouvement n&apos;est pas compris</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/rapids/findings.py"/>
        <source>{0} would be at {1} {2} on the retract before or after the bead, its limit is {3} {4}, and no other height, direction or rotation keeps within limits; lower process.between_layers.lift or move the part in the cell</source>
        <translation>{0} serait à {1} {2} au retrait avant ou après le cordon, sa limite est {3} {4}, et aucune autre hauteur, direction ou rotation ne reste dans les limites ; diminuez process.between_layers.lift ou déplacez la pièce dans la cellule</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/findings.py"/>
        <source>{0} would be at {1} {2}, its limit is {3} {4}</source>
        <translation>{0} serait à {1} {2}, sa limite est {3} {4}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/findings.py"/>
        <source>{0} would be at {1} {2}, its limit is {3} {4}; move the part on the table</source>
        <translation>{0} serait à {1} {2}, sa limite est {3} {4} ; déplacez la pièce sur la table</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/model/bead_table.py"/>
        <source>{0} {1} is not a number; mend the row, or leave it out</source>
        <translation>{0} {1} n&apos;est pas un nombre ; corrigez la ligne, ou retirez-la</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/feature.py"/>
        <source>{0} {1} is not a straight line; choose a straight edge or an axis</source>
        <translation>{0} {1} n&apos;est pas une droite ; choisissez une arête droite ou un axe</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/model/bead_model.py"/>
        <source>{0} {1} {2} is not a positive number; mend the row, or leave it out</source>
        <translation>{0} {1} {2} n&apos;est pas un nombre positif ; corrigez la ligne, ou retirez-la</translation>
    </message>
    <message>
        <location filename="../../freecad_am/sections/quantity.py"/>
        <source>{0} {1}; give {2}</source>
        <translation>{0} {1} ; donnez {2}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/proposed_family.py"/>
        <source>{0}, and layers have the bend of {1} where it stands</source>
        <translation>{0}, et les couches ont la courbure de {1} là où elle repose</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/proposed_family.py"/>
        <source>{0}, and less than 1% of its surface hangs over by more than 45 deg</source>
        <translation>{0}, et moins de 1 % de sa surface surplombe de plus de 45 deg</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/proposed_family.py"/>
        <source>{0}, and less than 1% of its surface hangs over by more than 45 deg, stacked along {1}</source>
        <translation>{0}, et moins de 1 % de sa surface surplombe de plus de 45 deg, empilé suivant {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/model/bead_model.py"/>
        <source>{0}, and {1}</source>
        <translation>{0}, et {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/proposed_family.py"/>
        <source>{0}, and {1} of its surface hangs over by more than 45 deg</source>
        <translation>{0}, et {1} de sa surface surplombent de plus de 45 deg</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/proposed_family.py"/>
        <source>{0}, and {1} of its surface hangs over by more than 45 deg, stacked along {2}</source>
        <translation>{0}, et {1} de sa surface surplombent de plus de 45 deg, empilé suivant {2}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/proposed_family.py"/>
        <source>{0}, and {1} of its surface hangs over by more than 45 deg, stacked along {2}, which layers along the way through it carry</source>
        <translation>{0}, et {1} de sa surface surplombent de plus de 45 deg, empilé suivant {2}, que portent des couches le long du chemin à travers elle</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/proposed_family.py"/>
        <source>{0}, and {1} of its surface hangs over by more than 45 deg, stacked along {2}, which layers along the way through it carry; stacked along {3} it would be {4}</source>
        <translation>{0}, et {1} de sa surface surplombent de plus de 45 deg, empilé suivant {2}, que portent des couches le long du chemin à travers elle ; empilé suivant {3}, ce serait {4}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/proposed_family.py"/>
        <source>{0}, and {1} of its surface hangs over by more than 45 deg, stacked along {2}; a machine that tilts could lay layers: {3}, which need no support</source>
        <translation>{0}, et {1} de sa surface surplombent de plus de 45 deg, empilé suivant {2} ; une machine qui incline pourrait déposer des couches : {3}, qui se passent de support</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/proposed_family.py"/>
        <source>{0}, and {1} of its surface hangs over by more than 45 deg, stacked along {2}; a machine that tilts could lay layers: {3}, which need no support; stacked along {4} it would be {5}</source>
        <translation>{0}, et {1} de sa surface surplombent de plus de 45 deg, empilé suivant {2} ; une machine qui incline pourrait déposer des couches : {3}, qui se passent de support ; empilé suivant {4}, ce serait {5}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/proposed_family.py"/>
        <source>{0}, and {1} of its surface hangs over by more than 45 deg, stacked along {2}; curved layers need a flat face that it stands on, which it has not</source>
        <translation>{0}, et {1} de sa surface sont en porte-à-faux de plus de 45 deg, empilée suivant {2} ; des couches courbes demandent une face plane sur laquelle elle repose, qu&apos;elle n&apos;a pas</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/proposed_family.py"/>
        <source>{0}, and {1} of its surface hangs over by more than 45 deg, stacked along {2}; curved layers need a flat face that it stands on, which it has not; stacked along {3} it would be {4}</source>
        <translation>{0}, et {1} de sa surface sont en porte-à-faux de plus de 45 deg, empilée suivant {2} ; des couches courbes demandent une face plane sur laquelle elle repose, qu&apos;elle n&apos;a pas ; empilée suivant {3} ce serait {4}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/proposed_family.py"/>
        <source>{0}, and {1} of its surface hangs over by more than 45 deg, which layers along the way through it carry</source>
        <translation>{0}, et {1} de sa surface surplombent de plus de 45 deg, que portent des couches le long du chemin à travers elle</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/proposed_family.py"/>
        <source>{0}, and {1} of its surface hangs over by more than 45 deg, which layers along the way through it carry; stacked along {2} it would be {3}</source>
        <translation>{0}, et {1} de sa surface surplombent de plus de 45 deg, que portent des couches le long du chemin à travers elle ; empilé suivant {2}, ce serait {3}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/proposed_family.py"/>
        <source>{0}, and {1} of its surface hangs over by more than 45 deg; a machine that tilts could lay layers: {2}, which need no support</source>
        <translation>{0}, et {1} de sa surface surplombent de plus de 45 deg ; une machine qui incline pourrait déposer des couches : {2}, qui se passent de support</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/proposed_family.py"/>
        <source>{0}, and {1} of its surface hangs over by more than 45 deg; a machine that tilts could lay layers: {2}, which need no support; stacked along {3} it would be {4}</source>
        <translation>{0}, et {1} de sa surface surplombent de plus de 45 deg ; une machine qui incline pourrait déposer des couches : {2}, qui se passent de support ; empilé suivant {3}, ce serait {4}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/proposed_family.py"/>
        <source>{0}, and {1} of its surface hangs over by more than 45 deg; curved layers need a flat face that it stands on, which it has not</source>
        <translation>{0}, et {1} de sa surface sont en porte-à-faux de plus de 45 deg ; des couches courbes demandent une face plane sur laquelle elle repose, qu&apos;elle n&apos;a pas</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/proposed_family.py"/>
        <source>{0}, and {1} of its surface hangs over by more than 45 deg; curved layers need a flat face that it stands on, which it has not; stacked along {2} it would be {3}</source>
        <translation>{0}, et {1} de sa surface sont en porte-à-faux de plus de 45 deg ; des couches courbes demandent une face plane sur laquelle elle repose, qu&apos;elle n&apos;a pas ; empilée suivant {2} ce serait {3}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/deposit/balance.py"/>
        <source>{0}, {1} of {2} cm3 of {3}, are not deposited</source>
        <translation>{0}, {1} des {2} cm3 de {3}, ne sont pas déposés</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/shapes/chosen.py"/>
        <source>{0}. Besides, {1}</source>
        <translation>{0}. De plus, {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/staubli/read.py"/>
        <source>{0}/{1}.pgx line {2}</source>
        <translation>{0}/{1}.pgx ligne {2}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/deposit/balance.py"/>
        <source>{0}: a wall of one bead, {1} mm wide, is planned</source>
        <translation>{0} : une paroi d’un seul cordon, de {1} mm de large, est prévue</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/deposit/balance.py"/>
        <source>{0}: beads of {1} mm do not reach into what is narrower, layers not above the last cut, and nothing is laid within a hub; use narrower beads, or lower layers</source>
        <translation>{0} : les cordons de {1} mm n&apos;entrent pas dans ce qui est plus étroit, les couches ne montent pas au-dessus de la dernière coupe, et rien n&apos;est déposé dans un moyeu ; prenez des cordons plus étroits, ou des couches plus basses</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/joint_path.py"/>
        <source>{0}: checked for the nozzle, and for links and part only in simulation and preflight; give cell.arm_clearance so that these are kept clear of it while planning</source>
        <translation>{0} : vérifié pour la buse, et pour les segments et la pièce dans la simulation et le contrôle préalable seulement ; donnez cell.arm_clearance pour que ceux-ci l&apos;évitent dès la planification</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/machines/draft.py"/>
        <source>{0}: controller.matrix</source>
        <translation>{0} : controller.matrix</translation>
    </message>
    <message>
        <location filename="../../freecad_am/plots/process.py"/>
        <source>{0}: distance to the layer before (asked: {1} mm)</source>
        <translation>{0} : distance à la couche précédente (demandée : {1} mm)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/cell.py"/>
        <source>{0}: external axes need the tool on the robot; use setup: tool-on-robot, or leave external out</source>
        <translation>{0} : des axes à côté du robot demandent l&apos;outil sur le robot ; utilisez setup: tool-on-robot, ou omettez external</translation>
    </message>
    <message>
        <location filename="../../freecad_am/api.py"/>
        <source>{0}: give source, and any of {1}</source>
        <translation>{0} : donnez source, et au besoin {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/whole_mesh.py"/>
        <source>{0}: its triangles enclose {1} cm3 and its faces {2} cm3; check and export the part again, or deposit it from a mesh</source>
        <translation>{0} : ses triangles enferment {1} cm3 et ses faces {2} cm3 ; contrôlez la pièce et exportez-la de nouveau, ou déposez-la à partir d&apos;un maillage</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/fit_layers.py"/>
        <source>{0}: layer {1} lies on what was scanned, {2} to {3} mm from the plan, now within {4} mm; {5} layers lead back to the plan. {6} points were used, {7} that face another way left out; along the beads it rises by up to {8} deg against the plan{9}</source>
        <translation>{0} : la couche {1} repose sur ce qui a été numérisé, de {2} à {3} mm du plan, maintenant à moins de {4} mm ; {5} couches ramènent au plan. {6} points ont été regardés, {7} tournés ailleurs laissés de côté ; le long des cordons elle monte de {8} deg au plus par rapport au plan{9}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/planning/plan.py"/>
        <source>{0}: of no effect on a machine with two rotary axes, which leaves no rotation about the tool to choose; leave out what is meant for robots</source>
        <translation>{0} : sans effet sur une machine à deux axes rotatifs, qui ne laisse pas de rotation autour de l&apos;outil à choisir ; retirez ce qui est fait pour les robots</translation>
    </message>
    <message>
        <location filename="../../freecad_am/objects/planned/scan.py"/>
        <source>{0}: only a scan in the part&apos;s own coordinates shows how far a part has grown; give none</source>
        <translation>{0} : seule une numérisation dans les coordonnées de la pièce dit jusqu&apos;où une pièce a grandi ; donnez none</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/deposit/balance.py"/>
        <source>{0}: solids are built up on the hub, which is there before</source>
        <translation>{0} : les solides sont construits sur le moyeu, qui est là avant</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/walls/mesh_wall.py"/>
        <source>{0}: where facets meet at an angle the wall runs smoothly, up to {1} mm off them, at {2}</source>
        <translation>{0} : là où des facettes se rencontrent sous un angle la paroi est lissée, jusqu&apos;à {1} mm de celles-ci, en {2}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/issues.py"/>
        <source>{0}: {1}</source>
        <translation>{0} : {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/mesh/solid.py"/>
        <source>{0}: {1} edges, the first at {2}; {3}</source>
        <translation>{0} : {1} arêtes, la première en {2} ; {3}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/bead_classes.py"/>
        <source>{0}: {1} has no number; {2}</source>
        <translation>{0} : {1} ne donne pas de nombre ; {2}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/obstacles.py"/>
        <source>{0}: {1} is not a pose; give six numbers x y z RX RY RZ</source>
        <translation>{0} : {1} n&apos;est pas une pose ; donnez six nombres x y z RX RY RZ</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/parameters/obstacles.py"/>
        <source>{0}: {1} mm is not a box; give three lengths of more than 0 mm, at most {2} mm</source>
        <translation>{0} : {1} mm n&apos;est pas une boîte ; donnez trois longueurs de plus de 0 mm, au plus {2} mm</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/revolution/wall.py"/>
        <source>{0}: {1} mm off; choose other faces</source>
        <translation>{0} : écart de {1} mm ; choisissez d&apos;autres faces</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/revolution/wall.py"/>
        <source>{0}: {1} mm off; name the faces of the wall if it is not part of it</source>
        <translation>{0} : écart de {1} mm ; nommez les faces de la paroi si elle n&apos;en fait pas partie</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/refusals.py"/>
        <source>{0}: {1}; use another way, or another controller</source>
        <translation>{0} : {1} ; prenez une autre manière, ou un autre contrôleur</translation>
    </message>
    <message>
        <location filename="../../freecad_am/interop/export.py"/>
        <source>{0}; choose a file you can write</source>
        <translation>{0} ; choisissez un fichier que vous pouvez écrire</translation>
    </message>
    <message>
        <location filename="../../freecad_am/macro/export.py"/>
        <source>{0}; choose a folder you can write to</source>
        <translation>{0} ; choisissez un dossier où vous pouvez écrire</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/files/three_mf.py"/>
        <source>{0}; export the part again</source>
        <translation>{0} ; exportez la pièce de nouveau</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/strategies/solids/notes.py"/>
        <source>{0}; for one speed give {1}</source>
        <translation>{0} ; pour une seule vitesse, donnez {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/refusals.py"/>
        <source>{0}; leave it out, or use another controller</source>
        <translation>{0} ; omettez-le, ou utilisez une autre commande</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/model/bead_model.py"/>
        <source>{0}; measure at least two speeds</source>
        <translation>{0} ; mesurez au moins deux vitesses</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/process/model/bead_model.py"/>
        <source>{0}; measure at least two speeds and two radii</source>
        <translation>{0} ; mesurez au moins deux vitesses et deux rayons</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/refusals.py"/>
        <source>{0}; set program.motion to cartesian with the tool on the robot (fanuc, yaskawa; abb with program.schedule.by: arc too), or process.weave, also in process.classes, to 0</source>
        <translation>{0} ; mettez program.motion à cartesian avec l&apos;outil sur le robot (fanuc, yaskawa ; abb aussi avec program.schedule.by: arc), ou process.weave, aussi dans process.classes, à 0</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/nodes/machine_links.py"/>
        <source>{0}; the link has its plain solid for now</source>
        <translation>{0} ; le corps garde pour l&apos;instant son solide simple</translation>
    </message>
    <message>
        <location filename="../../freecad_am/brep/hub.py"/>
        <source>{0}; up to strategy.mend, {1} mm, what is open is closed, and the widest place is {2} mm across</source>
        <translation>{0} ; jusqu&apos;à strategy.mend, {1} mm, ce qui est ouvert est fermé, et l&apos;endroit le plus large a {2} mm</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/refusals.py"/>
        <source>{0}; use constant, or another controller</source>
        <translation>{0} ; utilisez constant, ou une autre commande</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/refusals.py"/>
        <source>{0}; use process.between_layers.input, strategy.wait, or another controller</source>
        <translation>{0} ; utilisez process.between_layers.input, strategy.wait, ou une autre commande</translation>
    </message>
    <message>
        <location filename="../../freecad_am/posts/abb/modules.py"/>
        <source>{0}; write the program again</source>
        <translation>{0} ; écrivez le programme de nouveau</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/geometry/mesh/repair.py"/>
        <source>{0}; {1}</source>
        <translation>{0} ; {1}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/read_back/events.py"/>
        <source>{0}; {1} of {2} events</source>
        <translation>{0} ; {1} événements sur {2}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/read_back/planned.py"/>
        <source>{0}; {1} of {2} moves</source>
        <translation>{0} ; {1} de {2} mouvements</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/urdf/elements.py"/>
        <source>{0}={1} of &lt;{2}&gt; holds {3}, which is not a number; write one such as 0.25</source>
        <translation>{0}={1} de &lt;{2}&gt; contient {3}, qui n&apos;est pas un nombre ; écrivez-en un comme 0.25</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/kinematics/urdf/elements.py"/>
        <source>{0}={1} of &lt;{2}&gt; is not {3} numbers; write so many, with blanks between</source>
        <translation>{0}={1} de &lt;{2}&gt; n&apos;est pas {3} nombres ; écrivez-en autant, séparés par des espaces</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/facts.py"/>
        <source>{:.1f} mm long in {:.1f} s</source>
        <translation>long de {:.1f} mm en {:.1f} s</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/cladding.py"/>
        <source>{:.4g} cm² in 1 layer</source>
        <translation>{:.4g} cm² en 1 couche</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/cladding.py"/>
        <source>{:.4g} cm² in each of {} layers</source>
        <translation>{:.4g} cm² par couche, en {} couches</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/facts.py"/>
        <source>{:.4g} mm wide</source>
        <translation>large de {:.4g} mm</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/fit_plot.py"/>
        <source>{:g} mm wide: {} where straight, {} where r is {:g} mm</source>
        <translation>largeur {:g} mm : {} en ligne droite, {} là où r est {:g} mm</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/simulation/wording.py"/>
        <source>{achieved} instead of {asked}</source>
        <translation>{achieved} au lieu de {asked}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/simulation/wording.py"/>
        <source>{condition:.3f} (at least {threshold:.3f})</source>
        <translation>{condition:.3f} (au moins {threshold:.3f})</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/simulation/fields.py"/>
        <source>{count} findings</source>
        <translation>{count} remarques</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/simulation/wording.py"/>
        <source>{label} cannot keep the speed: {than} becomes {value}</source>
        <translation>{label} ne peut pas tenir la vitesse : {than} devient {value}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/simulation/wording.py"/>
        <source>{label} comes within {value:.2f}{unit} of its limit</source>
        <translation>{label} approche à {value:.2f}{unit} de sa limite</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/simulation/wording.py"/>
        <source>{label} is {value:.2f}{unit} past its limit</source>
        <translation>{label} dépasse de {value:.2f}{unit} sa limite</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/simulation/dock.py"/>
        <source>{label} was computed again</source>
        <translation>{label} a été recalculé</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/docks/lookout.py"/>
        <source>{label} was deleted</source>
        <translation>{label} a été supprimé</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/texts/touching.py"/>
        <source>{link} touches {what}</source>
        <translation>{link} touche {what}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/simulation/wording.py"/>
        <source>{mass:.1f} g</source>
        <translation>{mass:.1f} g</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/simulation/wording.py"/>
        <source>{metres:.3f} m</source>
        <translation>{metres:.3f} m</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/simulation/wording.py"/>
        <source>{time} where speeds are not kept</source>
        <translation>{time} là où les vitesses ne sont pas tenues</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/simulation/wording.py"/>
        <source>{volume:.2f} cm³</source>
        <translation>{volume:.2f} cm³</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/page.py"/>
        <source>{} (deg)</source>
        <translation>{} (deg)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/page.py"/>
        <source>{} (mm)</source>
        <translation>{} (mm)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/simulation/dock.py"/>
        <source>{} ({})</source>
        <translation>{} ({})</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/new_job/after.py"/>
        <source>{} Double-click a stage in the tree to change it.</source>
        <translation>{} Double-cliquez sur une étape dans l&apos;arbre pour la modifier.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/new_job/after.py"/>
        <source>{} Read the warnings first: double-click {}.</source>
        <translation>{} Lisez d&apos;abord les avertissements : double-cliquez sur {}.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/drawn/board.py"/>
        <source>{} against {} at layer {} bead {} point {}</source>
        <translation>{} contre {} à la couche {} cordon {} point {}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/pick.py"/>
        <source>{} are missing: click them in the tree or the 3D view.</source>
        <translation>{} manquent : cliquez dessus dans l&apos;arbre ou la vue 3D.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/drawn/board.py"/>
        <source>{} at layer {} bead {} point {}</source>
        <translation>{} à la couche {} cordon {} point {}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/at_rest.py"/>
        <source>{} at rest, its turning axes at 0</source>
        <translation>{} au repos, ses axes rotatifs à 0</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/fit_plot.py"/>
        <source>{} beads, {:g} to {:g} mm/min, r {:g} to {:g} mm, wire {:g} m/min</source>
        <translation>{} cordons, {:g} à {:g} mm/min, r {:g} à {:g} mm, fil {:g} m/min</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/picking/picking.py"/>
        <source>{} belongs to a job; select the part itself.</source>
        <translation>{} appartient à un travail ; sélectionnez la pièce elle-même.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/needs.py"/>
        <source>{} cannot be carried out: {}</source>
        <translation>{} ne peut pas être exécuté : {}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/cladding.py"/>
        <source>{} cannot be taken for this.</source>
        <translation>{} ne convient pas ici.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/saving.py"/>
        <source>{} cannot be written: {}</source>
        <translation>{} ne peut pas être écrit : {}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/poses_page.py"/>
        <source>{} counts the other way (sign)</source>
        <translation>{} compte dans l&apos;autre sens (signe)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/curves.py"/>
        <source>{} curves, {:.4g} mm in all</source>
        <translation>{} courbes, {:.4g} mm en tout</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/at_rest.py"/>
        <source>{} does not reach the part with the nozzle upright: all its axes are drawn at 0</source>
        <translation>{} n&apos;atteint pas la pièce avec la buse droite : tous ses axes sont dessinés à 0</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/cladding.py"/>
        <source>{} faces in 1 sheet</source>
        <translation>{} faces en 1 nappe</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/cladding.py"/>
        <source>{} faces in {} sheets</source>
        <translation>{} faces en {} nappes</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/new_job/after.py"/>
        <source>{} failed.</source>
        <translation>{} a échoué.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/standing.py"/>
        <source>{} failed: {}</source>
        <translation>{} a échoué : {}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/placement/dock.py"/>
        <source>{} has changed; compute again.</source>
        <translation>{} a changé ; calculez de nouveau.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/tool.py"/>
        <source>{} has no joint path to map; make one first, or select another job.</source>
        <translation>{} n&apos;a pas de trajectoire articulaire pour une carte ; faites-en d&apos;abord une, ou sélectionnez un autre travail.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/simulation/tool.py"/>
        <source>{} has no joint path to simulate; make one first, or select another job.</source>
        <translation>{} n&apos;a pas de trajectoire articulaire à simuler ; faites-en d&apos;abord une, ou sélectionnez un autre travail.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/needs.py"/>
        <source>{} has no result: {}</source>
        <translation>{} n&apos;a pas de résultat : {}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/picking/picking.py"/>
        <source>{} has no shape; select a body, solid, face, link or sketch.</source>
        <translation>{} n&apos;a pas de forme ; sélectionnez un corps, un solide, une face, un lien ou une esquisse.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/placement/tool.py"/>
        <source>{} has no toolpath with a cell to place; make one first, or select another job.</source>
        <translation>{} n&apos;a pas de trajectoire d&apos;outil avec une cellule à placer ; faites-en d&apos;abord une, ou sélectionnez une autre tâche.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/picking/shape_inputs.py"/>
        <source>{} is a mesh, which has no exact faces; select a part such as of a STEP file.</source>
        <translation>{} est un maillage, qui n&apos;a pas de faces exactes ; sélectionnez une pièce, par exemple d&apos;un fichier STEP.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/hub.py"/>
        <source>{} is another object; faces of a hub are of one object. Clear it first to start again.</source>
        <translation>{} est un autre objet ; les faces d&apos;un moyeu sont d&apos;un seul objet. Effacez d&apos;abord pour recommencer.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/wall.py"/>
        <source>{} is another object; faces of a wall are of one object. Clear it first to start again.</source>
        <translation>{} est un autre objet ; les faces d&apos;une paroi sont d&apos;un seul objet. Effacez d&apos;abord pour recommencer.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/background/busy.py"/>
        <source>{} is being computed</source>
        <translation>{} est en cours de calcul</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/path/dock.py"/>
        <source>{} is hidden, or has no result.</source>
        <translation>{} est caché, ou n&apos;a pas de résultat.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/new_job/after.py"/>
        <source>{} is infeasible.</source>
        <translation>{} est infaisable.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/standing.py"/>
        <source>{} is infeasible: {}</source>
        <translation>{} est infaisable : {}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/pick.py"/>
        <source>{} is missing: click it in the tree or the 3D view.</source>
        <translation>{} manque : cliquez dessus dans l&apos;arbre ou la vue 3D.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/picking/shape_inputs.py"/>
        <source>{} is missing: select it and press its Use selection.</source>
        <translation>{} manque : sélectionnez-le et cliquez sur Prendre.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/poses_page.py"/>
        <source>{} is moved by {} mm and turned by {} deg</source>
        <translation>{} est déplacé de {} mm et tourné de {} deg</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/figure_table.py"/>
        <source>{} is not a number; enter one such as 12.5</source>
        <translation>{} n&apos;est pas un nombre ; saisissez-en un comme 12.5</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/limits_page.py"/>
        <source>{} is not below {}; enter the smaller end first</source>
        <translation>{} n&apos;est pas inférieur à {} ; saisissez d&apos;abord la plus petite extrémité</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/preview.py"/>
        <source>{} is out of date; this is of what it was.</source>
        <translation>{} n&apos;est pas à jour ; ceci est de ce qu&apos;il était.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/new_job/after.py"/>
        <source>{} is stale.</source>
        <translation>{} est périmé.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/saving.py"/>
        <source>{} is written.</source>
        <translation>{} est écrit.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/picking/picking.py"/>
        <source>{} links to nothing: what it showed is gone or was not loaded.</source>
        <translation>{} ne lie à rien : ce qu&apos;il montrait a disparu ou n&apos;a pas été chargé.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/fit_plot.py"/>
        <source>{} mm/min (the fastest of the table)</source>
        <translation>{} mm/min (la plus rapide du tableau)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/fit_plot.py"/>
        <source>{} mm/min (the slowest of the table)</source>
        <translation>{} mm/min (la plus lente du tableau)</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/picking/picking.py"/>
        <source>{} objects are selected; pick the substrate</source>
        <translation>{} objets sont sélectionnés ; choisissez le substrat</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/picking/picking.py"/>
        <source>{} objects are selected; pick the wall and the substrate</source>
        <translation>{} objets sont sélectionnés ; choisissez la paroi et le substrat</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/consequences.py"/>
        <source>{} of the points tried do not serve: they are red</source>
        <translation>{} des points regardés ne conviennent pas : ils sont rouges</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/redundancy_map/figures.py"/>
        <source>{} of them past a limit only because an axis runs out of turns along its bead</source>
        <translation>dont {} au-delà d&apos;une limite seulement parce qu&apos;un axe n&apos;a plus de tours le long de son cordon</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/placement/figures.py"/>
        <source>{} of {} poses are feasible, as far as {} of {} points show.</source>
        <translation>{} poses sur {} sont réalisables, d&apos;après {} points sur {}.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/fields.py"/>
        <source>{} or empty</source>
        <translation>{} ou vide</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/program/located.py"/>
        <source>{} point {}</source>
        <translation>{} point {}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/machine_wizard/poses_page.py"/>
        <source>{} shows {} at zero</source>
        <translation>{} montre {} à zéro</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/new_job/proposal.py"/>
        <source>{} solids are selected, which are filled</source>
        <translation>{} solides sont sélectionnés, qui sont remplis</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/features/solid.py"/>
        <source>{} solids, {:.4g} mm high</source>
        <translation>{} solides, {:.4g} mm de haut</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/export_path.py"/>
        <source>{} was written</source>
        <translation>{} a été écrit</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/at_rest.py"/>
        <source>{} with the nozzle upright: {} is {:.0f}° from its limit</source>
        <translation>{} avec la buse droite sur la pièce : {} est à {:.0f}° de sa limite</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/at_rest.py"/>
        <source>{} with the nozzle upright: {} is {:.0f}° past its limit</source>
        <translation>{} avec la buse droite sur la pièce : {} dépasse sa limite de {:.0f}°</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/stage.py"/>
        <source>{}, {}</source>
        <translation>{}, {}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/tool.py"/>
        <source>{}. {}</source>
        <translation>{}. {}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/panels/stage.py"/>
        <source>{}: advanced</source>
        <translation>{} : avancé</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/context_menu.py"/>
        <source>{}: cancelled</source>
        <translation>{} : annulé</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/program/located.py"/>
        <source>{}: on the way there</source>
        <translation>{} : en chemin vers lui</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/new_job/after.py"/>
        <source>{}: proposed for this job: {}; enter what yours really has.</source>
        <translation>{} : proposé pour ce travail : {} ; saisissez ce que la vôtre a réellement.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/background/busy.py"/>
        <source>{}: {}</source>
        <translation>{} : {}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/cell/proposing.py"/>
        <source>{}: {} is now {}. {}</source>
        <translation>{} : {} est maintenant {}. {}</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/plots/words.py"/>
        <source>{}: {} points beyond the limit</source>
        <translation>{} : {} points au-delà de la limite</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/new_job/panel.py"/>
        <source>{}: {}.</source>
        <translation>{} : {}.</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/widgets/choices.py"/>
        <source>µm</source>
        <translation>µm</translation>
    </message>
    <message>
        <location filename="../../freecad_am/plots/joints.py"/>
        <source>σmin / σmax</source>
        <translation>σmin / σmax</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/texts/translation.py"/>
        <source>“{}”</source>
        <translation>« {} »</translation>
    </message>
    <message>
        <location filename="../../freecad_am/core/inspection/table.py"/>
        <source>… std. dev.</source>
        <translation>… écart type</translation>
    </message>
</context>
<context>
    <name>RoboticAM_Cell</name>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Adds a cell: machine, set-up, platform and nozzle</source>
        <translation>Ajoute une cellule : machine, installation, plateau et buse</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Cell…</source>
        <translation>Cellule…</translation>
    </message>
</context>
<context>
    <name>RoboticAM_Cladding</name>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Cladding…</source>
        <translation>Rechargement…</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Takes the selected faces to be covered with layers of beads</source>
        <translation>Prend les faces sélectionnées pour les recouvrir de couches de cordons</translation>
    </message>
</context>
<context>
    <name>RoboticAM_Curves</name>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Curves…</source>
        <translation>Courbes…</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Takes the selected edges, wires, sketches or tables to be laid as beads</source>
        <translation>Prend les arêtes, fils, esquisses ou tableaux sélectionnés pour les déposer en cordons</translation>
    </message>
</context>
<context>
    <name>RoboticAM_ExportPath</name>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Export Path…</source>
        <translation>Exporter la trajectoire…</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Writes a path as STEP or DXF wires, a table or a report, or makes a CAM path or Robot trajectory of it</source>
        <translation>Écrit une trajectoire en fils STEP ou DXF, en tableau ou en rapport, ou en fait une trajectoire CAM ou Robot</translation>
    </message>
</context>
<context>
    <name>RoboticAM_Feature</name>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Feature…</source>
        <translation>Élément…</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Takes the selected shape of revolution to be deposited</source>
        <translation>Prend la forme de révolution sélectionnée pour la déposer</translation>
    </message>
</context>
<context>
    <name>RoboticAM_Inspect</name>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Compares measured points with what was planned</source>
        <translation>Compare des points mesurés à ce qui était prévu</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Inspect…</source>
        <translation>Contrôler…</translation>
    </message>
</context>
<context>
    <name>RoboticAM_JointPath</name>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Joint Path…</source>
        <translation>Trajectoire articulaire…</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Plans the joint values of a toolpath in a cell</source>
        <translation>Planifie les valeurs articulaires d&apos;une trajectoire d&apos;outil dans une cellule</translation>
    </message>
</context>
<context>
    <name>RoboticAM_NewJob</name>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Makes all stages for the selected shape, from cell to program</source>
        <translation>Fait toutes les étapes pour la forme sélectionnée, de la cellule au programme</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>New Job…</source>
        <translation>Nouveau travail…</translation>
    </message>
</context>
<context>
    <name>RoboticAM_NewMachine</name>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Makes a machine file from a URDF, a Denavit-Hartenberg table or OPW figures, checked against poses</source>
        <translation>Fait un fichier machine d&apos;un URDF, d&apos;un tableau de Denavit-Hartenberg ou de cotes OPW, vérifié par des poses</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>New Machine…</source>
        <translation>Nouvelle machine…</translation>
    </message>
</context>
<context>
    <name>RoboticAM_OpenPart</name>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Open Part…</source>
        <translation>Ouvrir une pièce…</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Opens a part or mesh from a file, which may be damaged: it is read in a process of its own</source>
        <translation>Ouvre une pièce ou un maillage d&apos;un fichier, qui peut être abîmé : il est lu dans un processus à part</translation>
    </message>
</context>
<context>
    <name>RoboticAM_Path</name>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Path</source>
        <translation>Trajectoire</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Shows a toolpath or joint path layer by layer and point by point</source>
        <translation>Montre une trajectoire d&apos;outil ou articulaire couche par couche et point par point</translation>
    </message>
</context>
<context>
    <name>RoboticAM_Placement</name>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Placement…</source>
        <translation>Placement…</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Tries where the part, its positioner or the deposition point can stand, and shows the robot&apos;s reach</source>
        <translation>Essaie où la pièce, son positionneur ou le point de dépôt peut se trouver, et montre la portée du robot</translation>
    </message>
</context>
<context>
    <name>RoboticAM_Plots</name>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Plots joints against limits, distances between layers and deposit rates</source>
        <translation>Trace les articulations par rapport à leurs limites, les distances entre couches et les débits de dépôt</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Plots…</source>
        <translation>Graphiques…</translation>
    </message>
</context>
<context>
    <name>RoboticAM_Program</name>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Program…</source>
        <translation>Programme…</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Writes the controller&apos;s program of a joint path</source>
        <translation>Écrit le programme de la commande pour une trajectoire articulaire</translation>
    </message>
</context>
<context>
    <name>RoboticAM_Simulate</name>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Plays a joint path or program with its machine</source>
        <translation>Joue une trajectoire articulaire ou un programme avec sa machine</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Simulate…</source>
        <translation>Simuler…</translation>
    </message>
</context>
<context>
    <name>RoboticAM_Solid</name>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Solid…</source>
        <translation>Solide…</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Takes the selected solids to be deposited in plane layers</source>
        <translation>Prend les solides sélectionnés à déposer en couches planes</translation>
    </message>
</context>
<context>
    <name>RoboticAM_SolidsOnHub</name>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Solids on Hub…</source>
        <translation>Solides sur moyeu…</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Takes the selected solids to be deposited on the cylinder or cone that is selected last</source>
        <translation>Prend les solides sélectionnés pour les déposer sur le cylindre ou le cône sélectionné en dernier</translation>
    </message>
</context>
<context>
    <name>RoboticAM_SpinMap</name>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Free Rotation Map…</source>
        <translation>Carte de la rotation libre…</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Shows the path against the rotation about the tool; the curve can be drawn by hand</source>
        <translation>Montre la trajectoire en fonction de la rotation autour de l&apos;outil ; la courbe peut être tracée à la main</translation>
    </message>
</context>
<context>
    <name>RoboticAM_Toolpath</name>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Cuts a feature into layers and beads</source>
        <translation>Découpe un élément en couches et en cordons</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Toolpath…</source>
        <translation>Trajectoire d&apos;outil…</translation>
    </message>
</context>
<context>
    <name>RoboticAM_WallOnPart</name>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Takes the selected faces as a wall to be deposited on the other object that is selected</source>
        <translation>Prend les faces sélectionnées comme paroi à déposer sur l&apos;autre objet sélectionné</translation>
    </message>
    <message>
        <location filename="../../freecad_am/gui/tools/commands.py"/>
        <source>Wall on Part…</source>
        <translation>Paroi sur pièce…</translation>
    </message>
</context>
</TS>
